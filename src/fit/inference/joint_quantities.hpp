#pragma once

#include <ceres/jet.h>

#include <Eigen/Dense>
#include <functional>
#include <optional>
#include <vector>

#include "fit/inference/joint_covariance.hpp"
#include "slipfit/core/estimate.hpp"

namespace slipfit::fit {

/// The values of a sweep: those of JointShared, then at the reference load and over JointScales::force F_k(0+), the
/// difference F_s - F_k(0+) (means over the recordings where each has its own) and the rate of ageing. Where static
/// friction ages, the difference is that after a stick of JointScales::stick_s.
inline constexpr int kLevelValue = static_cast<int>(kJointShared);
inline constexpr int kDifferenceValue = kLevelValue + 1;
inline constexpr int kAgeingValue = kLevelValue + 2;
inline constexpr int kSweepValues = kLevelValue + 3;
using SweepJet = ceres::Jet<double, kSweepValues>;
using SweepVector = Eigen::Matrix<double, kSweepValues, 1>;
using SweepMatrix = Eigen::Matrix<double, kSweepValues, kSweepValues>;

/// Of a solution; static friction constant, or ageing as its recordings say.
enum class StaticFriction { Constant, Ages };
SweepVector sweep_values(const JointSolution& solution, StaticFriction kind);
SweepMatrix sweep_covariance(const JointSolution& solution, const JointCovariance& covariance, StaticFriction kind);

/// zeta cannot be negative: where its best value is, the best values given zeta = 0 (by the covariance, to second
/// order).
SweepVector with_damping_cut(const SweepVector& values, const SweepMatrix& covariance);

/// The sweep's parameters in SI with their derivatives.
struct SweepModel {
  SweepJet stiffness, omega, zeta, slope, alpha, level, difference, ageing;

  SweepModel(const SweepVector& values, const JointScales& scales);

  /// b (exp(alpha v) - 1) / alpha: how far F_k(v) lies above F_k(0+).
  [[nodiscard]] SweepJet excess_friction(double speed_m_per_s) const;
  /// V times the period of the limit cycle; empty where there is none.
  [[nodiscard]] std::optional<SweepJet> spacing(double speed_m_per_s, double load) const;

  /// The limit cycle of a given F_s - F_k(0+) at the reference load; empty where there is none.
  struct Cycle {
    SweepJet period_s, stick_s;
  };
  [[nodiscard]] std::optional<Cycle> cycle(double speed_m_per_s, double load, const SweepJet& difference_N) const;

 private:
  /// After the sticks of this speed.
  [[nodiscard]] std::optional<SweepJet> aged_difference_N(double speed_m_per_s, double load) const;

  double reference_stick_s_ = 1.0;
};

/// How the sweep's values move from their best ones with alpha held lower and higher, the nearest first, inside its
/// confidence interval.
struct RateProfile {
  struct Point {
    SweepVector move;
    double root = 0.0;  ///< of the rise in the sum of squares, in standard errors
  };
  std::vector<Point> lower, higher;
};

/// Student's t interval of a function of the sweep's parameters; along alpha as far as its profile says, where there is
/// one, and never less than the covariance says.
class SweepIntervals {
 public:
  SweepIntervals(const SweepMatrix& covariance, double degrees_of_freedom, const RateProfile& profile = {});

  [[nodiscard]] double error(const SweepJet& y) const;
  [[nodiscard]] Estimate plain(const SweepJet& y) const;
  /// Symmetric in the logarithm: the sign is known.
  [[nodiscard]] Estimate of_one_sign(const SweepJet& y) const;
  /// Of a quantity that bends over the interval of alpha: its values along alpha's profile, without one at alpha's ends
  /// with the other parameters following alpha as their covariance says; and the error that is left with alpha held.
  /// The standard error is that of the longer side.
  [[nodiscard]] Estimate through_rate(const SweepVector& values, const JointScales& scales,
                                      const std::function<SweepJet(const SweepModel&)>& quantity) const;
  [[nodiscard]] double covariance(const SweepJet& a, const SweepJet& b) const { return a.v.dot(matrix_ * b.v); }
  [[nodiscard]] double quantile() const { return quantile_; }
  [[nodiscard]] double degrees_of_freedom() const { return degrees_of_freedom_; }

 private:
  /// How far below and above its value a quantity reaches, both at least 0.
  struct Reach {
    double down = 0.0;
    double up = 0.0;
  };
  /// The farthest of these changes along alpha, with the error that is left with alpha held.
  [[nodiscard]] Reach reach_of(const SweepJet& y, const std::vector<double>& changes) const;
  [[nodiscard]] Reach reach_of(const SweepJet& y) const;
  [[nodiscard]] Estimate from_reach(double value, const Reach& reach) const;

  SweepMatrix matrix_;
  SweepMatrix rate_held_;           ///< covariance with alpha held
  std::vector<SweepVector> moves_;  ///< along alpha, to both sides
  double degrees_of_freedom_;
  double quantile_;
};

}  // namespace slipfit::fit
