#pragma once

#include "slipfit/core/estimate.hpp"

namespace slipfit {

/// A free oscillation of the rig that decays, after its release or at the end of a motion that becomes steady sliding.
struct RingDown {
  Estimate frequency_Hz;  ///< of the damped oscillation
  Estimate damping_ratio;
};

}  // namespace slipfit
