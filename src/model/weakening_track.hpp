#pragma once

#include <ceres/jet.h>

#include <limits>

#include "model/phasor.hpp"
#include "model/weakening.hpp"

namespace slipfit::model {

/// WeakeningSlip::at, to rounding, at times in ascending order and at even steps, of which some may be left out: the
/// motion is that of a linear equation, which the same few numbers take from each time to the next.
class WeakeningTrack {
 public:
  /// `step_tau`: above 0. The slip must outlive it.
  WeakeningTrack(const WeakeningSlip& slip, double step_tau);

  WeakeningPoint at(double tau);

 private:
  using Jet = WeakeningSlip::Jet;
  /// Derivatives with respect to the coefficients of the equation that slides obey while the friction falls,
  /// x'' + 2 zeta x' - g x = tau: g, zeta.
  using Slope = ceres::Jet<double, 2>;

  /// Whether the last time was one step before, in the same part of the slip.
  [[nodiscard]] bool is_next(double tau) const { return tau < last_tau_ + 1.5 * step_tau_; }
  [[nodiscard]] WeakeningPoint weakening_at(double tau);
  [[nodiscard]] WeakeningPoint weakened_at(double tau);
  [[nodiscard]] WeakeningPoint shown(const Jet& z, const Jet& dz, double ddz) const;
  /// From g and zeta to z0, zeta and the distance.
  [[nodiscard]] Jet chained(const Slope& value) const;

  const WeakeningSlip& slip_;
  Slope g_, zeta_;
  // What a step adds to x and x', of 1, tau, x and x' before it:
  Slope x_by_x_, x_by_v_, x_by_tau_, x_by_one_;
  Slope v_by_x_, v_by_v_;  // (x_by_v_ of tau, and x_by_tau_ of 1)
  Slope x_, v_;            // at last_tau_
  double step_tau_;
  double last_tau_ = -std::numeric_limits<double>::infinity();
  double b_;
  Phasor phasor_;
  bool is_weakened_ = false;  ///< the last time was
  Jet z_sine_, slope_sine_;
};

}  // namespace slipfit::model
