#pragma once

#include <span>
#include <vector>

namespace slipfit {

/// Mean and standard deviation of some values.
struct MeanAndSpread {
  double mean = 0.0;
  double sd = 0.0;
  double count = 0.0;
};

/// All 0 where there are no values, sd 0 for one.
MeanAndSpread describe(const std::vector<double>& values);

/// Slope of the least-squares line, and its standard error for residuals of their own each.
struct Slope {
  double value = 0.0;
  double standard_error = 0.0;  ///< 0 for two points
};

/// At least two points, not all at one x.
Slope slope_of(std::span<const double> x, std::span<const double> y);

}  // namespace slipfit
