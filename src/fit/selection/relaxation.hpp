#pragma once

#include <span>

#include "fit/problem/sweep_data.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/fit/sweep_recording.hpp"

namespace slipfit::fit {

/// Returns the recordings with a spring that relaxes (docs/model.md section 10) where that explains them better than
/// sticks that are straight or rise over a displacement, and than k that varies with the speed; otherwise the
/// recordings are returned as they are. The time of relaxation is the same at all speeds.
SweepData with_relaxation(SweepData data, std::span<const SweepRecording> recordings, const HeldParameters& held);

}  // namespace slipfit::fit
