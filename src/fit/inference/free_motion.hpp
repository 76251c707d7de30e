#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "fit/coordinates.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/fit/ring_down.hpp"

namespace slipfit::fit {

/// What is known of an oscillation of the rig: ln w_n and zeta, and the covariance of their errors.
struct FreeMotion {
  Eigen::Vector2d values = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();

  /// "5.1 ± 0.2 Hz with a damping ratio of 0.10 ± 0.03": the damped oscillation, with standard errors; zeta where it is
  /// told.
  [[nodiscard]] std::string words() const;
};

/// Of slips; `off`: how far averaging that nobody stated may move their ln w_n.
FreeMotion motion_of_slips(const Coordinates& values, const CoordinateMatrix& covariance, double off);

/// Of a ring-down; its intervals hold with Student's t of these degrees of freedom.
FreeMotion motion_of(const RingDown& ring, double degrees_of_freedom);

/// Slips and a ring-down beside each other.
struct SameMotion {
  std::optional<FreeMotion> both{};  ///< of slips and ring together, where they agree and the slips tell enough
  bool differs = false;              ///< by more than chance: not one motion
};

/// Least squares of both; where they differ by more than their errors, but not beyond chance, with errors as much
/// larger. The slips tell enough where another mode of the rig would not agree by chance.
SameMotion compare_motions(const FreeMotion& slips, const FreeMotion& ring);

/// What to say of slips and a ring-down that are not one motion.
Warning differing_motions(const FreeMotion& slips, const FreeMotion& ring);

/// What the coordinates move by with ln w_n and with zeta, a column each.
using MotionMoves = Eigen::Matrix<double, kCoordinates, 2>;

/// A covariance found with w_n and zeta held, as it is with their errors.
CoordinateMatrix with_motion(const CoordinateMatrix& held, const MotionMoves& moves, const FreeMotion& motion);

}  // namespace slipfit::fit
