#pragma once

#include <optional>
#include <span>

#include "fit/selection/solution.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/fit/sweep_recording.hpp"

namespace slipfit::fit {

/// The average of the sensor that a sweep found.
std::optional<FittedAverage> found_average(const FitResult& result);

/// The recordings say nothing of zeta: its interval is all of [0, 1], or an average hides most of their slips and they
/// do not agree.
bool is_damping_open(const FitResult& result, std::span<const SweepRecording> recordings);

/// Says of a fit with zeta held at 0 that the recordings say nothing of it.
void report_open_damping(FitResult& result);

}  // namespace slipfit::fit
