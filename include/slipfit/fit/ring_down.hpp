#pragma once

#include "slipfit/core/estimate.hpp"

namespace slipfit {

/// A free oscillation of the rig that dies out, after its release or of a motion that ends in steady sliding.
struct RingDown {
  Estimate frequency_Hz;  ///< of the damped oscillation
  Estimate damping_ratio;
};

}  // namespace slipfit
