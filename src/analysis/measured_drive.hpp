#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/signal/cycles.hpp"

namespace slipfit {

/// What a recording would be if its drive moved steadily.
struct SteadyDrive {
  Recording recording;          ///< its speed is the mean speed of the drive while the body sticks
  std::vector<double> removed;  ///< force of the recording less that of a steady drive, for every sample
  Estimate stiffness_N_per_m;   ///< slope of the force against the measured position while the body sticks
  double share_in_slips = 0.0;  ///< its motion less a steady one in a slip, as a force over the drop
};

/// Returns the recording as under a steady drive; nothing if the position of the drive is not measured, if it is not
/// that of the drive, if no sticks precede sudden slips, or if it moves steadily at the stated speed. `fit` gives the
/// natural frequency and the times of the slips; without it the detected slips do. model.md (30)
std::optional<SteadyDrive> at_steady_drive(const Recording& recording, const Segmentation& segmentation,
                                           const FitResult* fit);

/// The fit of a recording under a steady drive, with its forces as the sensor shows them, and an interval of the
/// stiffness that includes the slope of the force against the position.
FitResult as_measured(FitResult fit, const Recording& recording, const SteadyDrive& drive);

}  // namespace slipfit
