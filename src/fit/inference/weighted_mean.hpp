#pragma once

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <vector>

namespace slipfit::fit {

/// A value with its standard error, above 0.
struct Measured {
  double value = 0.0;
  double standard_error = 1.0;
};

/// The mean of values weighted by their errors.
struct WeightedMean {
  double value = 0.0;
  double standard_error = 0.0;
  double chance = 1.0;  ///< that equal values scatter as much as these do by their errors
};

/// Returns the mean of at least one value.
inline WeightedMean weighted_mean(const std::vector<Measured>& all) {
  double weights = 0.0;
  double sum = 0.0;
  for (const Measured& one : all) {
    const double weight = 1.0 / (one.standard_error * one.standard_error);
    weights += weight;
    sum += weight * one.value;
  }
  WeightedMean mean{sum / weights, 1.0 / std::sqrt(weights), 1.0};
  if (all.size() < 2) return mean;
  double square = 0.0;
  for (const Measured& one : all) square += std::pow((one.value - mean.value) / one.standard_error, 2);
  const boost::math::chi_squared_distribution<double> by_chance(static_cast<double>(all.size()) - 1.0);
  mean.chance = boost::math::cdf(boost::math::complement(by_chance, square));
  return mean;
}

}  // namespace slipfit::fit
