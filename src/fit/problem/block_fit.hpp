#pragma once

#include <array>
#include <vector>

#include "fit/cycle/cycle_data.hpp"
#include "fit/cycle/cycle_model.hpp"

namespace slipfit::fit {

/// Which shared parameters stand still in a solve.
struct Held {
  bool stiffness = false;
  bool frequency = false;
  bool damping = false;
};

struct SolveOptions {
  Held held;
  bool continuous = false;  ///< neighbouring cycles share their ramp (strong coupling, see kRampTolerance)
  bool robust = false;      ///< a cycle far worse than the others counts linearly, not squared
  int max_iterations = 60;
  /// Ends when a step gains less than this much of one residual's share of the cost: 1e-3 leaves the parameters within
  /// a few hundredths of a standard error, 0.1 is enough for a start.
  double tolerance = 1e-3;
};

/// SolveOptions::robust: a cycle whose residuals' root of the sum of squares is beyond it counts linearly.
double huber_bound(std::size_t residuals);

/// Cycles as blocks beside the shared parameters: a bundle adjustment. Owns data, models and the current solution.
class BlockFit {
 public:
  BlockFit(std::vector<CycleData> cycles, std::vector<double> reference_s, Scales scales, LevelModel level);
  BlockFit(const BlockFit&) = delete;  // models point into cycles
  BlockFit& operator=(const BlockFit&) = delete;
  BlockFit(BlockFit&&) = default;
  BlockFit& operator=(BlockFit&&) = default;
  ~BlockFit() = default;

  /// Levenberg-Marquardt by Ceres from `parameters`; cycle blocks are eliminated first (Schur complement). Returns the
  /// sum of squared residuals, infinity where the start is outside the model.
  double solve(const SolveOptions& options);

  /// Weighted sum of squares of one cycle's residuals at the solution; the part inside stick bins is not in it.
  [[nodiscard]] double cycle_sum_of_squares(std::size_t cycle) const;

  [[nodiscard]] std::size_t size() const { return models_.size(); }
  [[nodiscard]] const CycleModel& model(std::size_t cycle) const { return models_[cycle]; }
  [[nodiscard]] const CycleData& data(std::size_t cycle) const { return cycles_[cycle]; }
  [[nodiscard]] const Scales& scales() const { return scales_; }
  [[nodiscard]] const LevelModel& level() const { return level_; }
  [[nodiscard]] double reference_s(std::size_t cycle) const { return reference_s_[cycle]; }
  [[nodiscard]] const double* level_data() const { return parameters.level.data(); }
  [[nodiscard]] CycleState state(std::size_t cycle) const;

  Parameters parameters;

 private:
  std::vector<CycleData> cycles_;  // models_ point into it
  std::vector<double> reference_s_;
  Scales scales_;
  LevelModel level_;
  std::vector<CycleModel> models_;
};

/// The same cycles, models and solution once more.
BlockFit duplicate(const BlockFit& fit);

/// The ramp from the end of one slip to the onset of the next is one line: residual (kV (t2 - t1) + u I - A2) and its
/// derivatives with respect to shared (3), first own (2), second own (2), scaled by Scales::noise * kRampTolerance.
struct RampResidual {
  double value = 0.0;
  std::array<double, 3> d_shared{};
  std::array<double, 2> d_first{};
  std::array<double, 2> d_second{};
};
RampResidual ramp_residual(const BlockFit& fit, std::size_t first, const double* shared, const double* own_first,
                           const double* own_second);

/// In units of the noise: small enough to hold the ramp together (a ramp's mean is known to noise / sqrt(samples)),
/// large enough to keep the normal equations well conditioned.
inline constexpr double kRampTolerance = 0.01;

}  // namespace slipfit::fit
