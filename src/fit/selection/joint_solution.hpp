#pragma once

#include <memory>
#include <optional>

#include "fit/problem/joint_data.hpp"

namespace slipfit::fit {

/// A joint fit at its minimum.
struct JointSolution {
  std::unique_ptr<JointProblem> problem;
  JointHeld held{};
  double chi2 = 0.0;  ///< in units of each recording's own noise
  double degrees_of_freedom = 0.0;
};

/// What is tried: friction that depends on the speed, or Coulomb friction.
enum class SweepLaw { Coulomb, Velocity };

struct SweepFits {
  JointSolution velocity;
  std::optional<JointSolution> coulomb;  ///< with the same shares; empty: it has no minimum
  bool depends_on_speed = false;         ///< velocity explains more than chance would
  double p_value = 1.0;                  ///< that Coulomb friction gives such a difference by chance
};

/// Both laws, with everything shared between the recordings that the data agree with. Empty where no start converges.
std::optional<SweepFits> fit_sweep(const SweepData& data, const FitOptions& options);

/// The same fit with alpha v_c held at this rate, started from the solution.
std::optional<JointSolution> with_rate(const SweepData& data, const JointSolution& solution, double rate);

/// The same fit without one recording, started from the solution.
std::optional<JointSolution> leave_out(const SweepData& data, const JointSolution& solution, std::size_t recording);

}  // namespace slipfit::fit
