#pragma once

#include <Eigen/Dense>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fit/damped_fit.hpp"
#include "fit/joint_problem.hpp"
#include "slipfit/fit/joint.hpp"

namespace slipfit::fit {

/// A joint fit at its minimum.
struct JointSolution {
  std::unique_ptr<JointProblem> problem;
  JointHeld held{};
  double chi2 = 0.0;  ///< in units of each recording's own noise
  double degrees_of_freedom = 0.0;
};

/// The recordings of a sweep, fitted one by one: data, levels and starts of the joint fit. Recordings whose cycles
/// cannot be fitted are empty.
struct SweepData {
  std::vector<std::optional<DampedFit>> single;  ///< in the order of the recordings
  std::vector<SteadyRun> steady;
  std::vector<std::optional<std::size_t>> steady_of;  ///< index into `steady` of each recording
  std::vector<double> loads;                          ///< normal force over the first recording's; 1 where not known
  bool loads_known = false;
  JointScales scales;
  std::vector<std::size_t> fitted;  ///< recordings with cycles
};

/// From onset to onset; a cycle that could not be fitted makes one interval long.
double median_period_s(const BlockFit& blocks);

SweepData prepare_sweep(std::span<const SweepRecording> recordings, const FitOptions& options);

/// What is tried: friction that depends on the speed, or Coulomb friction.
enum class SweepLaw { Coulomb, Velocity };

struct SweepFits {
  JointSolution velocity;
  JointSolution coulomb;          ///< with the same shares
  bool depends_on_speed = false;  ///< velocity explains more than chance would
  double p_value = 1.0;           ///< that Coulomb friction gives such a difference by chance
};

/// Both laws, with everything shared between the recordings that the data agree with. Empty where no start converges.
std::optional<SweepFits> fit_sweep(const SweepData& data, const FitOptions& options);

/// The same fit without one recording, started from the solution.
std::optional<JointSolution> leave_out(const SweepData& data, const JointSolution& solution, std::size_t recording);

/// Covariance of JointProblem's columns: white noise, or the jackknife over cycles where residuals correlate.
struct JointCovariance {
  Eigen::MatrixXd matrix;
  double degrees_of_freedom = 1.0;
  bool from_cycles = false;
};
JointCovariance covariance_of(const SweepData& data, const JointSolution& solution);

}  // namespace slipfit::fit
