#pragma once

#include <vector>

namespace slipfit {

/// Median of the steps that are not zero, s; 0 where there is none. `time_s` never decreases.
double median_positive_step(const std::vector<double>& time_s);

}  // namespace slipfit
