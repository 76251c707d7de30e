#include "fit/inference/moderated.hpp"

#include <algorithm>
#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/polygamma.hpp>
#include <boost/math/special_functions/trigamma.hpp>
#include <cmath>
#include <optional>

namespace slipfit::fit {
namespace {

double degrees_of(const SampleVariance& sample) {
  return std::max(1.0, static_cast<double>(sample.count) - 1.0);
}

/// Mean of the logarithm of a chi-square variable over its degrees of freedom.
double mean_of_log(double degrees) {
  return boost::math::digamma(0.5 * degrees) - std::log(0.5 * degrees);
}

/// y with trigamma(y) = x > 0: Newton's method on 1 / trigamma, which is convex.
double inverse_trigamma(double x) {
  double y = 0.5 + 1.0 / x;
  for (int i = 0; i < 50; ++i) {
    const double value = boost::math::trigamma(y);
    const double step = value * (1.0 - value / x) / boost::math::polygamma(2, y);
    y += step;
    if (std::abs(step) < 1e-8 * y) break;
  }
  return y;
}

/// Holds the variance that the samples have in common, and how many degrees of freedom it counts for; empty: infinitely
/// many.
struct Common {
  double variance = 0.0;
  std::optional<double> degrees;
};

Common common_of(const std::vector<SampleVariance>& samples) {
  const auto count = static_cast<double>(samples.size());
  double mean = 0.0;
  double by_chance = 0.0;
  double weighted = 0.0;
  double weights = 0.0;
  std::vector<double> logs;
  for (const SampleVariance& sample : samples) {
    const double degrees = degrees_of(sample);
    logs.push_back(std::log(sample.variance) - mean_of_log(degrees));
    mean += logs.back() / count;
    by_chance += boost::math::trigamma(0.5 * degrees) / count;
    weighted += degrees * sample.variance;
    weights += degrees;
  }
  double square = 0.0;
  for (const double one : logs) square += (one - mean) * (one - mean);
  const double beyond_chance = square / (count - 1.0) - by_chance;
  if (!(beyond_chance > 0.0)) return {weighted / weights, std::nullopt};
  const double degrees = 2.0 * inverse_trigamma(beyond_chance);
  return {std::exp(mean + mean_of_log(degrees)), degrees};
}

}  // namespace

std::vector<double> moderated_variances(const std::vector<SampleVariance>& samples) {
  std::vector<double> moderated;
  const Common common = samples.size() > 1 ? common_of(samples) : Common{0.0, 0.0};
  for (const SampleVariance& sample : samples) {
    const double own = degrees_of(sample);
    moderated.push_back(common.degrees
                            ? (*common.degrees * common.variance + own * sample.variance) / (*common.degrees + own)
                            : common.variance);
  }
  return moderated;
}

}  // namespace slipfit::fit
