#pragma once

#include <optional>
#include <span>

#include "fit/inference/level_trend.hpp"
#include "fit/report/parameters.hpp"
#include "fit/selection/solution.hpp"
#include "fit/selection/tiers.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/fit/sweep_recording.hpp"

namespace slipfit::fit {

/// Adds what a trend of the level means for k and for absolute forces, where it changes them by more than their errors:
/// notes, and a warning.
void state_trend(const TrendFindings& trend, const Conditions& conditions, Findings& findings);

/// A bend of the ramps, what k may be off by because of it, and where it is.
struct Bend {
  double log_ratio = 0.0;
  double error = 0.0;  ///< of ln k
  const char* where = "";
};

/// Returns the bend that moves k most; the result is empty where none is clear. The slope of a bent ramp depends on the
/// part that is used, by half of the difference between its two halves. Creep before a slip flattens a stick, and a
/// rise of the force after a slip steepens its beginning: where a rise is fitted, it takes up part of the creep, and k
/// may be wrong by all of the bend in the second half of the sticks. `recordings`: how many are looked at for bends.
std::optional<Bend> bend_of(const BlockFit& blocks, std::size_t recordings = 1);

/// The average of the sensor that a sweep found.
std::optional<FittedAverage> found_average(const FitResult& result);

/// The recordings say nothing of zeta: its interval is all of [0, 1], or an average hides most of their slips and they
/// do not agree.
bool is_damping_open(const FitResult& result, std::span<const SweepRecording> recordings);

/// Says of a fit with zeta held at 0 that the recordings say nothing of it.
void report_open_damping(FitResult& result);

/// Of one recording: the best fit with zeta >= 0, and what it is uncertain by. `residual`: of the chosen tier.
Findings findings_of(const Recording& recording, const TierFits& fits, const Resolution& resolution,
                     const Residual& residual);

/// Returns the result without every number that is not fixed by the user: the motion is not the model's stick-slip.
FitResult without_parameters(FitResult fit);

/// Returns the fit with every identified parameter weak, for this reason.
FitResult without_identified(FitResult fit, const std::string& reason);

/// Qualifies the result of cycles that keep in step with the mains: hum is not visible in them and changes their
/// estimates. Where hum was found next to them, or next to their second harmonic in step, nothing is identified; where
/// none was found, it is assumed to be absent, with a warning. The third harmonic does no harm (docs/accuracy.md).
FitResult qualified_by_mains(FitResult fit, double frequency_Hz, double duration_s);

/// Slips far slower than the rig's own free ring-down may not be inertial: friction that weakens slowly or a viscous
/// film sets their time, unless what rings is lighter than the body that slips. Natural frequency, mass and damping are
/// weak; where the slips do not follow the model either (warning model_misfit) they are unknown, and F_s - F_k lies
/// between half of the drop (no damping) and all of it. `force_drop`: unit of the force column.
FitResult qualified_by_ring_down(FitResult fit, double ring_down_frequency_Hz, double force_drop);

}  // namespace slipfit::fit
