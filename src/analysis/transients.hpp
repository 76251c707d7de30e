#pragma once

#include "analysis/detect.hpp"
#include "slipfit/analysis.hpp"

namespace slipfit {

/// What the recording shows outside of the stretch that slides: the loading ramp and its first peak before it, a free
/// ring-down after it (after the release, or after the last slip of a motion that dies out).
Transients find_transients(const Detected& detected, MotionClass motion);

}  // namespace slipfit
