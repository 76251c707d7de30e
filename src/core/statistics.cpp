#include "core/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace slipfit {

namespace {

/// Moves the values for which `is_first` holds to the front and counts them. Every value is moved, whatever it is.
template <class Predicate>
std::size_t partition(std::span<double> values, const Predicate& is_first) {
  std::size_t count = 0;
  for (double& place : values) {
    const double value = place;
    place = values[count];
    values[count] = value;
    count += is_first(value) ? std::size_t{1} : 0;
  }
  return count;
}

double median_of_three(double a, double b, double c) {
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

}  // namespace

double nth_smallest(std::span<double> values, std::size_t index) {
  constexpr std::size_t kFew = 24;
  constexpr int kMostRounds = 64;  // pivots that part badly again and again are left to std::nth_element
  for (int round = 0; values.size() > kFew && round < kMostRounds; ++round) {
    const double pivot = median_of_three(values.front(), values[values.size() / 2], values.back());
    const std::size_t below = partition(values, [&](double value) { return value < pivot; });
    if (index < below) {
      values = values.first(below);
      continue;
    }
    const std::size_t equal = partition(values.subspan(below), [&](double value) { return value <= pivot; });
    if (index < below + equal) return pivot;
    if (below + equal == 0) break;  // the pivot is no number
    values = values.subspan(below + equal);
    index -= below + equal;
  }
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(index);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

namespace {

namespace policies = boost::math::policies;

// Boost would work in long double, which takes its time, for digits that no interval needs, and throw where an argument
// is out of range, which counts as probability 0 or 1 here.
using Quiet =
    policies::policy<policies::domain_error<policies::ignore_error>, policies::pole_error<policies::ignore_error>,
                     policies::overflow_error<policies::ignore_error>,
                     policies::underflow_error<policies::ignore_error>,
                     policies::evaluation_error<policies::ignore_error>, policies::promote_double<false>>;
using StudentsT = boost::math::students_t_distribution<double, Quiet>;
using Normal = boost::math::normal_distribution<double, Quiet>;
using ChiSquared = boost::math::chi_squared_distribution<double, Quiet>;
using FisherF = boost::math::fisher_f_distribution<double, Quiet>;

template <class Distribution>
double above(const Distribution& distribution, double x) {
  return boost::math::cdf(boost::math::complement(distribution, x));
}

}  // namespace

double t_quantile(double degrees_of_freedom, double probability) {
  return boost::math::quantile(StudentsT(std::max(1.0, degrees_of_freedom)), probability);
}

double t_chance(double t, double degrees_of_freedom) {
  return 2.0 * above(StudentsT(std::max(1.0, degrees_of_freedom)), std::abs(t));
}

double normal_quantile(double probability) {
  return boost::math::quantile(Normal(), probability);
}

double normal_above(double x) {
  return above(Normal(), x);
}

double chi_squared_above(double x, double degrees_of_freedom) {
  return above(ChiSquared(degrees_of_freedom), x);
}

double fisher_above(double ratio, double numerator, double denominator) {
  return above(FisherF(numerator, denominator), ratio);
}

double students_factor(double degrees_of_freedom) {
  return t_quantile(std::max(2.0, degrees_of_freedom)) / kNormalQuantile;
}

Estimate symmetric(double value, double se, double degrees_of_freedom) {
  const double half = t_quantile(degrees_of_freedom) * se;
  return {value, se, Interval{value - half, value + half}, {}};
}

Estimate scaled(Estimate estimate, double factor) {
  if (estimate.value) *estimate.value *= factor;
  if (estimate.standard_error) *estimate.standard_error *= factor;
  if (estimate.ci95) estimate.ci95 = Interval{estimate.ci95->low * factor, estimate.ci95->high * factor};
  return estimate;
}

Estimate including(Estimate estimate, double value) {
  const Interval ci95 = estimate.ci95.value_or(Interval{*estimate.value, *estimate.value});
  estimate.ci95 = Interval{std::min(ci95.low, value), std::max(ci95.high, value)};
  const double reach = std::max(estimate.ci95->high - *estimate.value, *estimate.value - estimate.ci95->low);
  estimate.standard_error = std::max(estimate.standard_error.value_or(0.0), reach / kNormalQuantile);
  return estimate;
}

double reach_towards(const Estimate& estimate, double other) {
  return other > *estimate.value ? estimate.ci95->high - *estimate.value : *estimate.value - estimate.ci95->low;
}

}  // namespace slipfit
