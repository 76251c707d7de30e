#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "fit/problem/block_fit.hpp"
#include "fit/problem/joint_cycle.hpp"

namespace slipfit::fit {

/// A recording of the sweep that slides steadily: its mean force is F_k(V).
struct SteadyRun {
  double speed_m_per_s = 0.0;
  double load = 1.0;
  double mean_force = 0.0;
  double standard_error = 0.0;
};

/// What the recordings of a sweep have in common beside JointShared; otherwise each has its own.
struct Shares {
  bool level = false;       ///< F_k(0+): no sensor zero or run-to-run friction between them
  bool difference = false;  ///< F_s - F_k(0+): static friction does not depend on the speed (no ageing)
};

/// Which shared parameters stand still.
using JointHeld = std::array<bool, kJointShared>;

/// The cycles of several recordings as blocks beside the parameters of the sweep: one bundle adjustment. The block
/// fits of the recordings lend their data and must outlive it.
class JointProblem {
 public:
  JointProblem(std::vector<const BlockFit*> recordings, std::vector<JointRun> runs, std::vector<SteadyRun> steady,
               JointScales scales, Shares shares);

  struct Parameters {
    JointShared shared{};
    std::vector<double> levels;       ///< F_k(0+) / scales.force: one, or one a recording
    std::vector<double> differences;  ///< (F_s - F_k(0+)) / scales.force: one, or one a recording
    std::vector<std::vector<double>> drifts;
    std::vector<std::vector<Own>> cycles;
  };
  Parameters parameters;

  /// Levenberg-Marquardt by Ceres, cycle blocks eliminated first. The sum of squared residuals, infinity where the
  /// start is outside the model.
  double solve(const JointHeld& held, int max_iterations, double tolerance);

  [[nodiscard]] std::size_t size() const { return runs_.size(); }
  [[nodiscard]] const JointRun& run(std::size_t i) const { return runs_[i]; }
  [[nodiscard]] const BlockFit& recording(std::size_t i) const { return *recordings_[i]; }
  [[nodiscard]] const JointScales& scales() const { return scales_; }
  [[nodiscard]] const Shares& shares() const { return shares_; }
  [[nodiscard]] std::size_t cycle_count() const;
  /// Residuals of all cycles and, where the level is shared, of the steady recordings.
  [[nodiscard]] double rows() const;

  /// Columns of `normals`: shared, levels, differences, drifts run by run.
  [[nodiscard]] std::size_t level_column(std::size_t run) const;
  [[nodiscard]] std::size_t difference_column(std::size_t run) const;
  [[nodiscard]] std::size_t columns() const;

  /// One cycle's (or steady recording's) share of the normal equations, its own parameters eliminated.
  struct Normal {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd score;  ///< J' r
  };
  [[nodiscard]] std::vector<Normal> normals() const;

  /// Residual of a steady recording and its derivatives with respect to shared and level.
  struct SteadyResidual {
    double value = 0.0;
    JointShared d_shared{};
    double d_level = 0.0;
  };
  [[nodiscard]] SteadyResidual steady_residual(const SteadyRun& run, const double* shared, double level) const;

 private:
  [[nodiscard]] JointValues values(std::size_t run, std::size_t cycle) const;
  [[nodiscard]] std::size_t drift_column(std::size_t run) const;
  [[nodiscard]] Normal normal_of(std::size_t run, std::size_t cycle) const;
  [[nodiscard]] Normal normal_of(const SteadyRun& run) const;

  std::vector<const BlockFit*> recordings_;
  std::vector<JointRun> runs_;
  std::vector<SteadyRun> steady_;
  JointScales scales_;
  Shares shares_;
  std::vector<std::vector<JointCycle>> cycles_;
};

}  // namespace slipfit::fit
