#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "fit/cycle/cycle_data.hpp"
#include "fit/cycle/shown_motion.hpp"
#include "model/relaxing.hpp"

namespace slipfit::fit {

/// A cycle on a spring that relaxes, in its view. The numbers of the law are the share that relaxes and the time.
class RelaxingMotion {
 public:
  static constexpr bool kStraightSticks = false;

  explicit RelaxingMotion(model::RelaxingSlip slip) : slip_(std::move(slip)) {}

  [[nodiscard]] MotionPoint at(double tau) const { return point_of(slip_.at(tau)); }
  [[nodiscard]] MotionPoint integral_to(double tau) const { return point_of(slip_.integral_to(tau)); }
  [[nodiscard]] double tau_end() const { return slip_.tau_end(); }
  [[nodiscard]] std::vector<model::SlipPart> parts() const { return slip_.parts(); }
  [[nodiscard]] const model::RelaxingSlip& slip() const { return slip_; }

 private:
  static MotionPoint point_of(const model::RelaxingSlip::Point& p) {
    return {p.z[0], p.d_tau, p.z[1], p.z[2], {p.z[3], p.z[4]}};
  }

  model::RelaxingSlip slip_;
};

/// One cycle under Coulomb friction on a spring that relaxes, as the sensor shows it, in the units of model/slip.hpp:
/// closed form.
class RelaxingCycle {
 public:
  using Point = ShownPoint;
  static constexpr bool kStraightSticks = false;

  /// Empty where the slip has no solution.
  static std::optional<RelaxingCycle> solve(double z0, double omega_rad_per_s, const Coordinates& values,
                                            const SensorTimes& sensor, const Scales& scales) {
    const double zeta = values(kDamping);
    const double share = values(kRelaxation);
    if (!(z0 + 2.0 * zeta > 0.0) || !(std::abs(zeta) < 1.0) || !std::isfinite(z0) || !(share >= 0.0 && share < 1.0)) {
      return std::nullopt;
    }
    const double w = omega_rad_per_s;
    const double time = w * std::exp(values(kRelaxationTime));
    const model::RelaxingSlip::Times times{time, scales.relaxing->slip, scales.relaxing->period};
    model::RelaxingSlip slip(z0, zeta, share, times, scales.view);
    return RelaxingCycle(std::move(slip), time, sensor.in_tau(w));
  }

  [[nodiscard]] double tau_end() const { return motion().tau_end(); }
  [[nodiscard]] bool resticks() const { return motion().slip().resticks(); }
  /// Spring force above the level at tau = 0 of the stick after the slip.
  [[nodiscard]] double intercept() const { return motion().slip().intercept(); }

  /// Force above the level in units of k V / w_n, at any tau = w_n (t - onset).
  [[nodiscard]] Point at(double tau) const { return shown_.at(tau); }

  /// Derivatives of the force with respect to zeta, the share and the logarithm of the time.
  [[nodiscard]] std::array<double, 3> by_law(const Point& point) const {
    return {point.d_zeta, point.d_law[0], time_ * point.d_law[1]};
  }
  /// Returns the derivative of the force with respect to ln w_n at fixed tau.
  [[nodiscard]] double by_log_omega(const Point& point) const { return point.d_log_omega + time_ * point.d_law[1]; }

  using Samples = SamplesOneByOne<RelaxingCycle>;

 private:
  RelaxingCycle(model::RelaxingSlip slip, double time, const Sensor& sensor)
      : shown_(RelaxingMotion(std::move(slip)), sensor), time_(time) {}

  [[nodiscard]] const RelaxingMotion& motion() const { return shown_.motion(); }

  ShownMotion<RelaxingMotion> shown_;
  double time_;  ///< w_n t_r
};

}  // namespace slipfit::fit
