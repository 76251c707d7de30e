#pragma once

#include <cstddef>

namespace slipfit::fit {

/// What the instrument does to the force of one cycle, in the scaled units of model/slip.hpp. docs/model.md section 7
/// - a low-pass filter with a Butterworth response of some order, of which the first is y' + kappa y = kappa z;
/// - a moving average over w_n W around the time stamp.
struct Sensor {
  double lag_tau = 0.0;      ///< by which the filter delays a slow ramp, times w_n; 0: no filter
  double average_tau = 0.0;  ///< w_n W; 0: none
  std::size_t order = 1;     ///< of the filter
};

}  // namespace slipfit::fit
