#pragma once

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

}  // namespace slipfit
