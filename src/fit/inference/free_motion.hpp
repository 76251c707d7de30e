#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "fit/coordinates.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/fit/ring_down.hpp"

namespace slipfit::fit {

/// Holds what is known of an oscillation of the rig: ln w_n and zeta, and the covariance of their errors.
struct FreeMotion {
  Eigen::Vector2d values = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();

  /// Returns "5.1 ± 0.2 Hz with a damping ratio of 0.10 ± 0.03": the damped oscillation, with standard errors; zeta
  /// only where it is determined.
  [[nodiscard]] std::string words() const;
};

/// Returns the motion of slips. `off` says how far averaging that nobody stated may move their ln w_n.
FreeMotion motion_of_slips(const Coordinates& values, const CoordinateMatrix& covariance, double off);

/// Returns the motion of a ring-down. Its intervals are right with Student's t of these degrees of freedom.
FreeMotion motion_of(const RingDown& ring, double degrees_of_freedom);

/// Holds the comparison of slips with a ring-down.
struct SameMotion {
  std::optional<FreeMotion> both{};  ///< of slips and ring together, where they agree and the slips suffice
  bool differs = false;              ///< by more than chance: not one motion
};

/// Computes the least-squares mean of both. Where they differ by more than their errors, but not by more than chance
/// explains, its errors are as much larger. The slips suffice where another mode of the rig would not agree by chance.
SameMotion compare_motions(const FreeMotion& slips, const FreeMotion& ring);

/// Returns the warning about slips and a ring-down that are not one motion.
Warning differing_motions(const FreeMotion& slips, const FreeMotion& ring);

/// Holds the moves of the coordinates with ln w_n and with zeta, a column each.
using MotionMoves = Eigen::Matrix<double, kCoordinates, 2>;

/// A covariance found with w_n and zeta held, as it is with their errors.
CoordinateMatrix with_motion(const CoordinateMatrix& held, const MotionMoves& moves, const FreeMotion& motion);

}  // namespace slipfit::fit
