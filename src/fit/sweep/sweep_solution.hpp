#pragma once

#include <optional>
#include <vector>

#include "core/thresholds.hpp"
#include "fit/problem/normals.hpp"
#include "fit/sweep/sweep_data.hpp"
#include "slipfit/fit/options.hpp"

namespace slipfit::fit {

/// The fit of a sweep at its minimum.
struct SweepSolution {
  std::vector<BlockFit> recordings;  ///< those with cycles
  SweepTerms sweep;
  Held held{};
  double chi2 = 0.0;  ///< in units of each recording's own noise
  double degrees_of_freedom = 0.0;

  [[nodiscard]] Problem problem() const { return {recordings, sweep}; }
  [[nodiscard]] std::size_t cycles() const;
  /// Returns the coordinates that the recordings share; the others are 0.
  [[nodiscard]] Coordinates shared() const;
  /// A recording with the time of the sensor that is free; null where none is.
  [[nodiscard]] const BlockFit* with_sensor_time() const;
  /// Returns the speeds of the recordings, in their order.
  [[nodiscard]] std::vector<double> speeds_m_per_s() const;
  /// At least `fewest` recordings at speeds that are far enough apart to show what varies with driving speed.
  [[nodiscard]] bool can_show_trend(std::size_t fewest = thresholds::kTrendRecordings) const;
  [[nodiscard]] const Population& population(std::size_t recording) const {
    return *recordings[recording].scales().population;
  }
};

/// The model leaves something out of the recordings.
bool is_misfit(const SweepSolution& solution);

/// How far a sweep is solved.
struct Accuracy {
  double tolerance = 1e-4;  ///< SolveOptions::tolerance
  int most_iterations = 50;
};

/// The solution, moved to its minimum with these coordinates held; empty where it has none.
std::optional<SweepSolution> at_minimum(SweepSolution solution, const Held& held, const Accuracy& accuracy = {});

/// At its minimum to a thousandth of a standard error.
SweepSolution settled(const SweepSolution& solution);

/// The same fit with alpha v_c held at this rate, started from the solution.
std::optional<SweepSolution> with_rate(const SweepSolution& solution, double rate);

/// The same fit with another law of kinetic friction, started from the solution.
std::optional<SweepSolution> with_law(const SweepSolution& solution, FrictionLaw law);

/// The solution with k that varies with driving speed as V^p, p free, moved to its minimum with these coordinates held.
std::optional<SweepSolution> with_exponent(SweepSolution solution, const Held& held);

/// The same fit with a coordinate that is held elsewhere.
std::optional<SweepSolution> with_held(const SweepSolution& solution, Coordinate coordinate, double change);

/// The solution with this w_n and zeta held.
std::optional<SweepSolution> with_motion(SweepSolution solution, const FreeMotion& motion);

/// A solution with its normal equations.
struct NormalSolution {
  SweepSolution solution;
  std::vector<Normal> normals;
};

/// The same fit without one of its recordings; empty where fewer than two are left. One step by the normal equations of
/// `all` where that is small, so that leaving out each of many recordings takes no longer than a fit of all; a fit
/// otherwise.
std::optional<NormalSolution> leave_out(const NormalSolution& all, std::size_t recording);

struct SweepFits {
  SweepSolution velocity;                ///< near enough to its minimum to compare sums of squares: see settled
  std::optional<SweepSolution> coulomb;  ///< sharing at most what velocity does; empty: it has no minimum
  /// Holds the fit under Coulomb friction with k that varies with driving speed, which may share more than `coulomb`
  /// does; empty where one k of all explains the recordings, or too few show it.
  std::optional<SweepSolution> growing{};
  double coulomb_chi2 = 0.0;      ///< with the shares of velocity
  double p_value = 0.0;           ///< that Coulomb friction with these gives such a difference by chance
  bool depends_on_speed = false;  ///< velocity explains more than chance would
};

/// Says how a fit of the rig is done.
enum class RigFit {
  Sharp,
  Rough,          ///< by a few cycles of each recording, whose chi2 it has, near enough to compare starts
  StiffnessGrows  ///< sharp, with k that varies with the speed
};

/// Fits Coulomb friction that the recordings do not share: they share the rig alone. Empty without a minimum.
std::optional<SweepSolution> fit_rig(const SweepData& data, const HeldParameters& held, RigFit kind = RigFit::Sharp);

/// Both laws, with everything shared between the recordings that the data agree with. Empty where no start converges.
std::optional<SweepFits> solve_sweep(const SweepData& data, const FitOptions& options);

}  // namespace slipfit::fit
