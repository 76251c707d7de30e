#include "surface/mean_spacing.hpp"
#include "core/student.hpp"

#include <algorithm>
#include <array>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace slipfit::surface {
namespace {

/// 1 + 2 rho: what is left of the variance of a mean of many distances whose neighbours have the correlation rho. The
/// first is that of a clock: places about even marks, the mean of whose distances they know best.
constexpr std::array kRemainders = {0.0, 0.03, 0.06, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0};

/// Half for a clock, the other half even over the rest.
double prior_of(std::size_t i) {
  if (i == 0) return 0.5;
  const double low = i == 1 ? 0.0 : 0.5 * (kRemainders[i - 1] + kRemainders[i]);
  const double high = i + 1 == kRemainders.size() ? kRemainders[i] : 0.5 * (kRemainders[i] + kRemainders[i + 1]);
  return 0.5 * (high - low) / kRemainders.back();
}

/// Student's t of the mean at one correlation, and how well that correlation explains the data.
struct Component {
  double centre = 0.0;
  double width = 0.0;
  double log_evidence = 0.0;
  double weight = 0.0;
};

/// Generalised least squares with the covariance tridiagonal (rho, 1, rho), factorised on the way.
Component component(std::span<const double> distances, double rho, double origin, double floor) {
  double pivot = 1.0;
  double ones = 1.0;
  double data = distances[0] - origin;
  double one_one = 0.0;
  double one_data = 0.0;
  double data_data = 0.0;
  double log_determinant = 0.0;
  for (std::size_t i = 0;; ++i) {
    one_one += ones * ones / pivot;
    one_data += ones * data / pivot;
    data_data += data * data / pivot;
    log_determinant += std::log(pivot);
    if (i + 1 == distances.size()) break;
    const double factor = rho / pivot;
    pivot = 1.0 - rho * factor;
    ones = 1.0 - factor * ones;
    data = distances[i + 1] - origin - factor * data;
  }
  const auto n = static_cast<double>(distances.size());
  const double rest = std::max(floor, data_data - one_data * one_data / one_one);
  return {origin + one_data / one_one, std::sqrt(rest / ((n - 2.0) * one_one)),
          -0.5 * (log_determinant + std::log(one_one) + (n - 2.0) * std::log(rest)), 0.0};
}

/// One for each remainder, their weights adding up to 1. Without a clock in the spectrum there is none in the places.
std::vector<Component> mixture_of(std::span<const double> distances, const std::optional<Clock>& clock,
                                  double miscount) {
  const auto n = static_cast<double>(distances.size());
  double origin = 0.0;
  for (const double d : distances) origin += d / n;
  const double floor = n * 1e-12 * origin * origin;
  std::vector<Component> mixture;
  double best = -std::numeric_limits<double>::infinity();
  for (const double remainder : kRemainders) {
    mixture.push_back(component(distances, 0.5 * (remainder - 1.0), origin, floor));
    best = std::max(best, mixture.back().log_evidence);
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < mixture.size(); ++i) {
    const bool is_possible = i > 0 || clock;
    mixture[i].weight = is_possible ? prior_of(i) * std::exp(mixture[i].log_evidence - best) : 0.0;
    mixture[i].width = std::hypot(mixture[i].width, miscount);
    sum += mixture[i].weight;
  }
  for (Component& c : mixture) c.weight /= sum;
  if (clock) {
    mixture.front().centre = clock->spacing;
    mixture.front().width = clock->standard_error;
  }
  return mixture;
}

double student_below(double t, double freedom) {
  using Plain = boost::math::policies::policy<boost::math::policies::promote_double<false>>;  // 1e-13 will do
  const double tail = 0.5 * boost::math::ibeta(0.5 * freedom, 0.5, freedom / (freedom + t * t), Plain());
  return t < 0.0 ? tail : 1.0 - tail;
}

double quantile(const std::vector<Component>& mixture, double freedom, double probability) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Component& c : mixture) {
    low = std::min(low, c.centre - 100.0 * c.width);
    high = std::max(high, c.centre + 100.0 * c.width);
  }
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    double below = 0.0;
    for (const Component& c : mixture) {
      if (c.weight > 1e-9) below += c.weight * student_below((middle - c.centre) / c.width, freedom);
    }
    (below < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::optional<MeanSpacing> mean_spacing(std::span<const double> distances, const std::optional<Clock>& clock,
                                        double miscount) {
  if (distances.size() < 4) return std::nullopt;
  const std::vector<Component> mixture = mixture_of(distances, clock, miscount);
  const double freedom = static_cast<double>(distances.size()) - 2.0;
  MeanSpacing mean;
  for (const Component& c : mixture) mean.value += c.weight * c.centre;
  mean.clock_share = mixture.front().weight;
  mean.ci95 = {quantile(mixture, freedom, 0.025), quantile(mixture, freedom, 0.975)};
  mean.standard_error = 0.5 * (mean.ci95.high - mean.ci95.low) / kNormalQuantile;
  return mean;
}

}  // namespace slipfit::surface
