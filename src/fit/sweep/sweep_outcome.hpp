#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fit/inference/intervals.hpp"
#include "fit/sweep/ageing_line.hpp"
#include "fit/sweep/sweep_solution.hpp"

namespace slipfit::fit {

/// The coordinates of a sweep at its solution: levels and differences of their own are means over the recordings, or a
/// line through them where static friction ages.
Coordinates coordinates_of(const SweepSolution& solution, const StaticFriction& kind);

/// White noise, or the jackknife over cycles where residuals of a recording correlate; scatter of the recordings' own
/// levels and differences included.
Spread spread_of(const SweepData& data, const SweepSolution& solution, const std::vector<Normal>& normals,
                 const StaticFriction& kind);

/// zeta cannot be negative: where its best value is, the best values given zeta = 0 (by the covariance, to second
/// order).
Coordinates with_damping_cut(const Coordinates& values, const Spread& spread);

/// Describes a law of kinetic friction other than the exponential one: F_k(0+), and so F_s - F_k(0+), depends on the
/// friction below the speeds that were measured.
struct OtherLaw {
  FrictionLaw law = FrictionLaw::Hyperbolic;
  double difference = 0.0;  ///< F_s - F_k(0+) under it / Units::force
  /// Says how far this law moves F_k(0+), F_s - F_k(0+) and, where Coulomb friction was chosen, zeta.
  Coordinates move = Coordinates::Zero();
};

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
  std::optional<OtherLaw> other_law{};           ///< that the recordings do not exclude
  bool disagree = false;  ///< the covariance is widened by what leaving out each recording changes
};

/// Fits once without each recording. The spread is that of the cycles and of the scatter between recordings alone.
SweepOutcome with_left_out(const SweepData& data, const SweepSolution& solution);

/// Returns the solution with its intervals.
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
