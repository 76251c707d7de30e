#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "fit/cycle/cycle_data.hpp"
#include "fit/cycle/cycle_model.hpp"

namespace slipfit::fit {

struct SolveOptions {
  Held held{};
  bool continuous = false;  ///< neighbouring cycles share their ramp (strong coupling, see kRampTolerance)
  bool robust = false;      ///< a cycle far worse than the others counts linearly, not squared
  int max_iterations = 60;
  /// Ends when a step gains less than this much of one residual's share of the cost: 1e-3 leaves the parameters within
  /// a few hundredths of a standard error, 0.1 is enough for a start.
  double tolerance = 1e-3;
};

/// SolveOptions::robust: a cycle whose residuals' root of the sum of squares is beyond it counts linearly.
double huber_bound(std::size_t residuals);

/// The parameters of a recording in a fit.
struct Parameters {
  Globals globals{};
  double difference = 0.0;    ///< F_s - F_k(0+) / Population::force, in a sweep
  std::vector<double> level;  ///< constant, where there is one, and drift; scaled by Scales::level_unit and force
  std::vector<Own> cycles;
};

/// A recording in a fit: cycles as blocks beside the globals, a bundle adjustment. The current solution of it.
class BlockFit {
 public:
  BlockFit(std::shared_ptr<const CycleSet> set, const Scales& scales);
  BlockFit(std::vector<CycleData> cycles, std::vector<double> reference_s, const Scales& scales, LevelModel level);

  /// By itself, from `parameters`: solve_together of one.
  double solve(const SolveOptions& options);

  /// Weighted sum of squares of one cycle's residuals at the solution; the part inside stick bins is not in it.
  [[nodiscard]] double cycle_sum_of_squares(std::size_t cycle) const;

  [[nodiscard]] std::size_t size() const { return models_.size(); }
  [[nodiscard]] const CycleModel& model(std::size_t cycle) const { return models_[cycle]; }
  [[nodiscard]] const CycleData& data(std::size_t cycle) const { return set_->cycles[cycle]; }
  [[nodiscard]] const std::shared_ptr<const CycleSet>& set() const { return set_; }
  [[nodiscard]] const Scales& scales() const { return scales_; }
  [[nodiscard]] const LevelModel& level() const { return set_->level; }
  [[nodiscard]] double reference_s(std::size_t cycle) const { return set_->reference_s[cycle]; }
  [[nodiscard]] const double* level_data() const { return parameters.level.data(); }
  [[nodiscard]] CycleValues values(std::size_t cycle) const;
  /// Under Coulomb friction, at a solution.
  [[nodiscard]] CycleState state(std::size_t cycle) const;

  Parameters parameters;

 private:
  std::shared_ptr<const CycleSet> set_;
  Scales scales_;
  std::vector<CycleModel> models_;
};

/// A recording of a sweep that slides steadily: its mean force is F_k(V).
struct SteadyRun {
  double speed_m_per_s = 0.0;
  double load = 1.0;
  double mean_force = 0.0;
  double standard_error = 0.0;
};

/// What the recordings of a sweep have in common beside the globals; otherwise each has its own.
struct Sharing {
  bool level = false;       ///< F_k(0+): no sensor zero or run-to-run friction between them
  bool difference = false;  ///< F_s - F_k(0+): static friction does not depend on the speed (no ageing)
};

/// Residual of a steady recording and its derivatives with respect to the globals and the level. `units` of the sweep.
struct SteadyResidual {
  double value = 0.0;
  Globals by_global{};
  double by_level = 0.0;
};
SteadyResidual steady_residual(const SteadyRun& run, const Units& units, const double* globals, double level);

/// What makes one problem of the recordings of a sweep. Steady ones enter where the level is shared.
struct SweepTerms {
  Sharing sharing{};
  std::span<const SteadyRun> steady{};
  Units units{};
};

/// The recordings of one sweep, or one recording, at a solution.
struct Problem {
  std::span<const BlockFit> recordings;
  SweepTerms sweep{};
};

/// Levenberg-Marquardt by Ceres from the recordings' parameters (globals: the first one's); cycle blocks are eliminated
/// first (Schur complement). Leaves the solution in all of them. Returns the sum of squared residuals, infinity where
/// the start is outside the model.
double solve_together(std::span<BlockFit> recordings, const SweepTerms& sweep, const SolveOptions& options);

/// The ramp from the end of one slip to the onset of the next is one line: residual (kV (t2 - t1) + u I - A2) and its
/// derivatives with respect to ln k, ln w_n and zeta, first own (2), second own (2), scaled by Scales::noise *
/// kRampTolerance. Coulomb friction.
struct RampResidual {
  double value = 0.0;
  std::array<double, 3> d_globals{};
  std::array<double, 2> d_first{};
  std::array<double, 2> d_second{};
};
RampResidual ramp_residual(const BlockFit& fit, std::size_t first, const double* globals, const double* own_first,
                           const double* own_second);

/// In units of the noise: small enough to hold the ramp together (a ramp's mean is known to noise / sqrt(samples)),
/// large enough to keep the normal equations well conditioned.
inline constexpr double kRampTolerance = 0.01;

}  // namespace slipfit::fit
