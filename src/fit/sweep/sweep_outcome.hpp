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

/// Adds the uncertainty of the cut-off of ageing, whose distribution is known.
void add_cutoff(const SweepSolution& solution, const StaticFriction& kind, Spread& spread);

/// zeta cannot be negative: where its best value is, the best values given zeta = 0 (by the covariance, to second
/// order).
Coordinates with_damping_cut(const Coordinates& values, const Spread& spread);

/// Holds the best coordinates and their spread along alpha. If alpha is known badly the sum of squares is no parabola
/// along it: alpha times zeta is known better than either, and a second minimum may have the other sign. The spread is
/// then from refits with alpha held, out to where the sum of squares has risen by the square of Student's quantile, and
/// from what `spread` says. Where alpha is known well, or held, it is from `spread` alone. `best` is the solution's
/// coordinates. A negative zeta is moved to the best of the profile with zeta >= 0, and the profile leads from there to
/// the others of these.
struct AlongRate {
  Coordinates best;
  Spread spread;
};
AlongRate profile_rate(const SweepSolution& solution, const StaticFriction& kind, const Coordinates& best,
                       const Spread& spread);

/// Describes a law of kinetic friction other than the exponential one: F_k(0+), and so F_s - F_k(0+), depends on the
/// friction below the speeds that were measured.
struct OtherLaw {
  FrictionLaw law = FrictionLaw::Hyperbolic;
  double difference = 0.0;  ///< F_s - F_k(0+) under it / Units::force
  /// Says how far this law moves F_k(0+), F_s - F_k(0+) and, where Coulomb friction was chosen, zeta.
  Coordinates move = Coordinates::Zero();
};

/// Returns the one with the largest move of the hyperbolic and the logarithmic laws that the recordings do not exclude.
/// The result is empty where they exclude all.
std::optional<OtherLaw> other_law(const SweepSolution& exponential, const StaticFriction& kind);

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

/// Adds what intervals need besides: other laws of kinetic friction, recordings that disagree, the profile of alpha.
SweepOutcome with_intervals(const SweepData& data, SweepOutcome outcome);

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
