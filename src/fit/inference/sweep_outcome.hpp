#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fit/inference/other_laws.hpp"
#include "fit/inference/sweep_coordinates.hpp"

namespace slipfit::fit {

/// A fit without one recording.
struct LeftOut {
  Coordinates values;
  Spread spread;
  SpeedReach reach;
};

/// A solution with its intervals.
struct SweepOutcome {
  SweepSolution solution;
  StaticFriction static_friction{};
  Coordinates values;  ///< zeta may be negative
  Spread spread;
  SpeedReach reach;
  std::vector<std::optional<LeftOut>> left_out;  ///< one for each of the solution's recordings
  std::optional<OtherLaw> other_law{};           ///< where kinetic friction depends on the speed
  bool disagree = false;  ///< the covariance is widened by what leaving out each recording changes
};

/// Fits once without each recording.
SweepOutcome outcome_of(const SweepData& data, const SweepSolution& solution);

/// Returns the spread with the trends of F_s - F_k and k at a speed outside those of the fit.
Spread spread_at(const LeftOut& fit, double speed_m_per_s);

/// Root mean square of ln (spacing predicted without a recording / its own); no prediction counts as a factor of 2.
double left_out_error(const SweepOutcome& outcome);

/// Residual variance over that of the noise measured on the traces: the noise of the sweep is that of each recording's
/// own fit, which may leave something out by itself.
double residual_over_noise(std::span<const SweepRecording> recordings, const SweepData& data,
                           const SweepSolution& solution);

/// Returns by how much averaging of the samples, if none is stated, may make w_n too small: over a step of the clock,
/// or what the slips of all recordings show together.
double effect_of_averaging(std::span<const SweepRecording> recordings, const SweepOutcome& outcome,
                           const SweepData& data);

}  // namespace slipfit::fit
