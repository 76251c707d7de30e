#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "fit/cycle/cycle_data.hpp"
#include "fit/cycle/shown_motion.hpp"
#include "model/weakening.hpp"

namespace slipfit::fit {

/// A slip under friction that weakens over a distance, in its view. The numbers of the law are the distance and none.
class WeakeningMotion {
 public:
  static constexpr bool kStraightSticks = true;

  explicit WeakeningMotion(model::WeakeningSlip slip) : slip_(std::move(slip)) {}

  [[nodiscard]] MotionPoint at(double tau) const { return point_of(slip_.at(tau)); }
  [[nodiscard]] MotionPoint integral_to(double tau) const { return point_of(slip_.integral_to(tau)); }
  [[nodiscard]] double tau_end() const { return slip_.tau_end(); }
  [[nodiscard]] std::vector<model::SlipPart> parts() const { return slip_.parts(); }
  [[nodiscard]] const model::WeakeningSlip& slip() const { return slip_; }

 private:
  static MotionPoint point_of(const model::WeakeningPoint& p) {
    return {p.z, p.d_tau, p.d_z0, p.d_zeta, {p.d_distance, 0.0}};
  }

  model::WeakeningSlip slip_;
};

/// One cycle under friction that weakens over a slip distance as the sensor shows it, in the units of model/slip.hpp:
/// closed form.
class WeakeningCycle {
 public:
  using Point = ShownPoint;
  static constexpr bool kStraightSticks = true;

  /// Solves the cycle. It is empty where D_c is far above (F_s - F_k) / k, from which on friction that weakens makes no
  /// stick-slip: a weak slip may lie above that limit, but not all.
  static std::optional<WeakeningCycle> solve(double z0, double omega_rad_per_s, const Coordinates& values,
                                             const SensorTimes& sensor, const Scales& scales) {
    const double root = values(kSlipDistance);
    const double unit = scales.slip_distance_m * omega_rad_per_s / scales.speed_m_per_s;
    const double zeta = values(kDamping);
    const double lambda = z0 + 2.0 * zeta;
    constexpr double kShortest = 1e-9;  // of lambda: Coulomb friction
    constexpr double kLongest = 1.5;    // of half the typical drop over k
    const double distance = std::max(unit * root * root, kShortest * lambda);
    if (!(lambda > 0.0) || !(std::abs(zeta) < 1.0) || !std::isfinite(z0) || !(root * root < kLongest)) {
      return std::nullopt;
    }
    WeakeningCycle cycle({z0, zeta, distance, scales.view}, sensor.in_tau(omega_rad_per_s));
    cycle.distance_ = distance;
    cycle.by_root_ = 2.0 * unit * root;
    return cycle;
  }

  [[nodiscard]] double tau_end() const { return slip().tau_end(); }
  [[nodiscard]] bool resticks() const { return slip().resticks(); }
  /// Spring force above the level at tau = 0 of the stick after the slip.
  [[nodiscard]] double intercept() const { return slip().intercept(); }

  /// Force above the level in units of k V / w_n, at any tau = w_n (t - onset).
  [[nodiscard]] Point at(double tau) const { return shown_.at(tau); }
  [[nodiscard]] Point before_slip(double tau) const { return at(tau); }
  [[nodiscard]] Point after_slip(double tau) const { return at(tau); }

  /// Derivatives of the force with respect to the law's coordinates, of the point's.
  [[nodiscard]] std::array<double, 2> by_law(const Point& point) const {
    return {point.d_zeta, by_root_ * point.d_law[0]};
  }
  /// Returns the derivative of the force with respect to ln w_n at fixed tau.
  [[nodiscard]] double by_log_omega(const Point& point) const { return point.d_log_omega + distance_ * point.d_law[0]; }

  /// The cycle at samples in ascending order; `step_tau` 0: not at even steps.
  class Samples {
   public:
    Samples(const WeakeningCycle& cycle, double step_tau) : cycle_(cycle) {
      if (step_tau > 0.0 && !(cycle.sensor_.lag_tau > 0.0)) {
        track_.emplace(cycle.slip(), step_tau, cycle.sensor_.average_tau);
      }
    }
    Point at(double tau) {
      if (!track_) return cycle_.at(tau);
      const model::WeakeningPoint p = track_->at(tau);
      return {{p.z, p.d_tau, p.d_z0, p.d_zeta, {p.d_distance, 0.0}}, p.d_log_omega, p.d_log_average};
    }

   private:
    const WeakeningCycle& cycle_;
    std::optional<model::WeakeningTrack> track_;
  };

 private:
  WeakeningCycle(model::WeakeningSlip slip, const Sensor& sensor)
      : shown_(WeakeningMotion(std::move(slip)), sensor), sensor_(sensor) {}

  [[nodiscard]] const model::WeakeningSlip& slip() const { return shown_.motion().slip(); }

  ShownMotion<WeakeningMotion> shown_;
  Sensor sensor_;
  double distance_ = 0.0;  ///< D_c w_n / V
  double by_root_ = 0.0;   ///< d distance_ / d kSlipDistance
};

}  // namespace slipfit::fit
