#include "compare/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/statistics.hpp"
#include "core/unknown.hpp"

namespace slipfit::comparing {
namespace {

constexpr double kMostFreedom = 1e6;  // as good as the normal distribution

double square(double x) {
  return x * x;
}

/// The degrees of freedom at which Student's t reaches `quantile` standard errors for 95 %.
double freedom_of(double quantile) {
  if (!(quantile > t_quantile(kMostFreedom))) return kMostFreedom;
  double low = 1.0;
  double high = kMostFreedom;
  while (high / low > 1.0 + 1e-6) {
    const double middle = std::sqrt(low * high);
    (t_quantile(middle) > quantile ? low : high) = middle;
  }
  return low;
}

/// Returns the degrees of freedom of the sum of two independent variances (Satterthwaite).
double joined_freedom(double variance_a, double freedom_a, double variance_b, double freedom_b) {
  const double sum = square(variance_a + variance_b);
  return sum > 0.0 ? sum / (square(variance_a) / freedom_a + square(variance_b) / freedom_b) : kMostFreedom;
}

struct OneFit {
  Reach reach;
  double degrees_of_freedom = kMostFreedom;
};

std::optional<OneFit> one_fit(const Estimate& estimate) {
  if (!estimate.value || !estimate.standard_error || !(*estimate.standard_error > 0.0)) return std::nullopt;
  const double normal = t_quantile(kMostFreedom) * *estimate.standard_error;
  const Interval bounds = estimate.ci95.value_or(Interval{*estimate.value - normal, *estimate.value + normal});
  OneFit one{{*estimate.value, std::max(0.0, *estimate.value - bounds.low),
              std::max(0.0, bounds.high - *estimate.value), *estimate.standard_error}};
  // The standard error is that of the longer side.
  one.degrees_of_freedom = freedom_of(std::max(one.reach.down, one.reach.up) / one.reach.standard_error);
  return one;
}

/// Mean and scatter of recordings; the scatter of one is not known.
struct Sample {
  double count = 0.0;
  double mean = 0.0;
  double variance = 0.0;    ///< between recordings
  double squared_se = 0.0;  ///< mean over the fits
};

Sample sample_of(std::span<const Estimate> estimates) {
  Sample sample;
  sample.count = static_cast<double>(estimates.size());
  for (const Estimate& estimate : estimates) {
    sample.mean += *estimate.value / sample.count;
    sample.squared_se += square(estimate.standard_error.value_or(0.0)) / sample.count;
  }
  for (const Estimate& estimate : estimates) sample.variance += square(*estimate.value - sample.mean);
  if (sample.count > 1.0) sample.variance /= sample.count - 1.0;
  return sample;
}

/// Returns the variance of the mean. Recordings scatter by at least the standard errors of their fits: if they appear
/// to scatter less, by chance or because all are at a bound, the standard errors are used.
double variance_of_mean(const Sample& sample, double variance) {
  return std::max(variance, sample.squared_se) / sample.count;
}

Reach symmetric_reach(double value, double variance, double quantile) {
  const double se = std::sqrt(variance);
  return {value, quantile * se, quantile * se, se};
}

}  // namespace

std::optional<Pair> by_standard_errors(const Estimate& a, const Estimate& b) {
  const auto fit_a = one_fit(a);
  const auto fit_b = one_fit(b);
  if (!fit_a || !fit_b) return std::nullopt;
  return Pair{fit_a->reach, fit_b->reach,
              joined_freedom(square(fit_a->reach.standard_error), fit_a->degrees_of_freedom,
                             square(fit_b->reach.standard_error), fit_b->degrees_of_freedom)};
}

std::optional<Pair> by_scatter(std::span<const Estimate> a, std::span<const Estimate> b) {
  const Sample sample_a = sample_of(a);
  const Sample sample_b = sample_of(b);
  const bool both = a.size() > 1 && b.size() > 1;
  const double variance_a = variance_of_mean(sample_a, a.size() > 1 ? sample_a.variance : sample_b.variance);
  const double variance_b = variance_of_mean(sample_b, b.size() > 1 ? sample_b.variance : sample_a.variance);
  if (!(variance_a + variance_b > 0.0)) return std::nullopt;
  const double freedom = both ? joined_freedom(variance_a, sample_a.count - 1.0, variance_b, sample_b.count - 1.0)
                              : std::max(sample_a.count, sample_b.count) - 1.0;
  const double quantile = t_quantile(freedom);
  return Pair{symmetric_reach(sample_a.mean, variance_a, quantile),
              symmetric_reach(sample_b.mean, variance_b, quantile), freedom};
}

Estimate mean_of(std::span<const Estimate> estimates) {
  if (estimates.size() == 1) return estimates.front();
  const Sample sample = sample_of(estimates);
  return symmetric(sample.mean, std::sqrt(variance_of_mean(sample, sample.variance)), sample.count - 1.0);
}

// The intervals of both numbers give that of their difference, also where they are lopsided: MOVER, Zou and Donner,
// Statistics in Medicine 27 (2008) 1693.
Estimate difference_of(const Pair& pair) {
  const double value = pair.b.value - pair.a.value;
  return {value,
          std::hypot(pair.a.standard_error, pair.b.standard_error),
          Interval{value - std::hypot(pair.b.down, pair.a.up), value + std::hypot(pair.b.up, pair.a.down)},
          {}};
}

// The ratios r for which the interval of b - r a holds 0 (Fieller), so that difference and ratio never disagree.
Estimate ratio_of(const Pair& pair) {
  const Reach& a = pair.a;
  const Reach& b = pair.b;
  if (!(a.value - a.down > 0.0)) return unknown("A may be 0 or below");
  if (!(b.value >= 0.0)) return unknown("B is below 0");
  const double ratio = b.value / a.value;
  const double product = a.value * b.value;
  const auto root = [&](double reach_a, double reach_b) {
    return std::sqrt(
        std::max(0.0, square(product) - (square(a.value) - square(reach_a)) * (square(b.value) - square(reach_b))));
  };
  const double low = (square(b.value) - square(b.down)) / (product + root(a.up, b.down));
  const double high = (product + root(a.down, b.up)) / (square(a.value) - square(a.down));
  // First order; the relative errors add as squares.
  const double se = std::hypot(b.standard_error, ratio * a.standard_error) / a.value;
  return {ratio, se, Interval{std::isfinite(low) ? std::max(0.0, low) : 0.0, high}, {}};
}

std::optional<double> p_value_of(const Pair& pair) {
  const Estimate difference = difference_of(pair);
  const double size = std::abs(*difference.value);
  const double reach = reach_towards(difference, 0.0);
  if (!(reach > 0.0)) return std::nullopt;
  return t_chance(size / reach * t_quantile(pair.degrees_of_freedom), pair.degrees_of_freedom);
}

std::vector<double> holm(const std::vector<double>& p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t i, std::size_t j) { return p_values[i] < p_values[j]; });
  std::vector<double> adjusted(p_values.size());
  double largest = 0.0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const auto left = static_cast<double>(order.size() - rank);
    largest = std::max(largest, std::min(1.0, left * p_values[order[rank]]));
    adjusted[order[rank]] = largest;
  }
  return adjusted;
}

}  // namespace slipfit::comparing
