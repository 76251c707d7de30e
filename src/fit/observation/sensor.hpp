#pragma once

#include <ceres/jet.h>

#include "model/slip.hpp"

namespace slipfit::fit {

/// What the instrument shows of one cycle, in the scaled units of model/slip.hpp. docs/model.md section 7
/// - a lag of first order, T F' + F = force: y' + kappa y = kappa z with kappa = 1 / (w_n T);
/// - a moving average over w_n W around the time stamp. All its integrals are in closed form.
struct Sensor {
  double lag_tau = 0.0;      ///< w_n T; 0: none
  double average_tau = 0.0;  ///< w_n W; 0: none
  bool transmitted = false;
};

/// A slip as such an instrument shows it. Where it does not lag, AveragedSlip says the same at less work.
class SensedSlip {
 public:
  SensedSlip(const Sensor& sensor, const model::Slip& slip);

  /// Returns the force that the sensor shows at any tau. The stick before the slip counts as long enough for the slip
  /// before it to be forgotten.
  [[nodiscard]] model::WavePoint at(double tau) const;

 private:
  /// Derivatives with respect to z0, zeta, tau, ln w_n.
  using Jet = ceres::Jet<double, 4>;

  /// Force, its derivative and its integral from the onset on.
  struct Force {
    Jet z, slope, integral;
  };

  /// exp(-zeta tau) cos b tau and exp(-zeta tau) sin b tau.
  struct Phase {
    Jet c, s;
  };

  [[nodiscard]] Phase phase_at(const Jet& tau) const;
  [[nodiscard]] Force in_slip(const Phase& phase) const;
  [[nodiscard]] Force force_at(const Jet& tau) const;
  [[nodiscard]] Jet lagged_in_slip(const Jet& tau) const;
  [[nodiscard]] Jet lagged_at(const Jet& tau) const;
  [[nodiscard]] Force shown_at(const Jet& tau) const;

  Sensor sensor_;
  Jet z0_, zeta_, b_, end_tau_, half_;
  Jet z_sine_, slope_sine_;  ///< of z = z0 c + z_sine s, z' = c - slope_sine s
  Force end_;
  Jet kappa_, lag_cosine_, lag_sine_, lag_rest_, lag_end_;  ///< of the lagging sensor, where there is one
};

}  // namespace slipfit::fit
