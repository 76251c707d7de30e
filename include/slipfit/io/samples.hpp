#pragma once

#include <string>
#include <vector>

namespace slipfit {

/// Columns in memory instead of a file; values that are not finite are left out and counted.
struct Samples {
  std::string name;           ///< in results and messages
  std::vector<double> time;   ///< in `options.time_unit`; empty: `options.sample_rate_Hz` is the clock
  std::vector<double> force;  ///< in `options.force_unit`, 1 for a coefficient of friction
};

}  // namespace slipfit
