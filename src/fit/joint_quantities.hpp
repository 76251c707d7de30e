#pragma once

#include <ceres/jet.h>

#include <Eigen/Dense>
#include <functional>
#include <optional>

#include "fit/joint_solution.hpp"
#include "slipfit/core/estimate.hpp"

namespace slipfit::fit {

/// ln k, ln w_n, zeta, beta, rate (JointShared), then F_k(0+) and F_s - F_k(0+) at the reference load, both over
/// JointScales::force and means over the recordings where each has its own.
inline constexpr int kSweepValues = 7;
using SweepJet = ceres::Jet<double, kSweepValues>;
using SweepVector = Eigen::Matrix<double, kSweepValues, 1>;
using SweepMatrix = Eigen::Matrix<double, kSweepValues, kSweepValues>;

SweepVector sweep_values(const JointSolution& solution);
SweepMatrix sweep_covariance(const JointSolution& solution, const JointCovariance& covariance);

/// The sweep's parameters in SI with their derivatives.
struct SweepModel {
  SweepJet stiffness, omega, zeta, slope, alpha, level, difference;

  SweepModel(const SweepVector& values, const JointScales& scales);

  /// b (exp(alpha v) - 1) / alpha: how far F_k(v) lies above F_k(0+).
  [[nodiscard]] SweepJet excess_friction(double speed_m_per_s) const;
  /// V times the period of the limit cycle; empty where there is none.
  [[nodiscard]] std::optional<SweepJet> spacing(double speed_m_per_s, double load) const;
};

/// Student's t interval of a function of the sweep's parameters.
class SweepIntervals {
 public:
  SweepIntervals(const SweepMatrix& covariance, double degrees_of_freedom);

  [[nodiscard]] double error(const SweepJet& y) const;
  [[nodiscard]] Estimate plain(const SweepJet& y) const;
  /// Symmetric in the logarithm: the sign is known.
  [[nodiscard]] Estimate of_one_sign(const SweepJet& y) const;
  /// Of a quantity that bends over the interval of alpha: its values at alpha's ends, the other parameters following
  /// alpha as their covariance says, and the error that is left with alpha held. The standard error is a quarter of the
  /// 95 % interval.
  [[nodiscard]] Estimate through_rate(const SweepVector& values, const JointScales& scales,
                                      const std::function<SweepJet(const SweepModel&)>& quantity) const;
  [[nodiscard]] double covariance(const SweepJet& a, const SweepJet& b) const { return a.v.dot(matrix_ * b.v); }
  [[nodiscard]] double quantile() const { return quantile_; }

 private:
  SweepMatrix matrix_;
  double quantile_;
};

}  // namespace slipfit::fit
