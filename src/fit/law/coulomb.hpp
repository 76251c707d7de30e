#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "fit/cycle/cycle_data.hpp"
#include "fit/observation/averaged_slip.hpp"
#include "fit/observation/sensor.hpp"
#include "fit/observation/shown_motion.hpp"
#include "model/phasor.hpp"
#include "model/slip.hpp"

namespace slipfit::fit {

/// A cycle under Coulomb friction, in its view. The law has no numbers.
class CoulombMotion {
 public:
  static constexpr bool kStraightSticks = true;

  CoulombMotion(const model::Slip& slip, const model::StickLine& after, ForceView view);

  [[nodiscard]] MotionPoint at(double tau) const;
  [[nodiscard]] MotionPoint integral_to(double tau) const { return force_.integral_to(tau); }
  [[nodiscard]] double tau_end() const { return slip_.tau_end; }
  [[nodiscard]] std::vector<model::SlipPart> parts() const;

 private:
  model::Slip slip_;
  model::StickLine after_;
  bool is_transmitted_;
  AveragedSlip force_;
};

/// One cycle under Coulomb friction as the sensor shows it, in the units of model/slip.hpp: closed form.
class CoulombCycle {
 public:
  using Point = model::WavePoint;
  static constexpr bool kStraightSticks = true;

  /// `z0`: spring force above F_k at the onset. Needs z0 + 2 zeta > 0 and |zeta| < 1.
  CoulombCycle(double z0, double zeta, const Sensor& sensor, ForceView view)
      : slip(model::solve_slip(z0, zeta)),
        after(model::stick_after(slip)),
        sensor_(sensor),
        is_transmitted_(view == ForceView::Transmitted) {
    if (sensor.lag_tau > 0.0) {
      filtered_.emplace(CoulombMotion(slip, after, view), sensor);
    } else if (sensor.average_tau > 0.0) {
      averaged_.emplace(slip, after, sensor.average_tau, is_transmitted_);
    }
  }

  model::Slip slip;
  model::StickLine after;

  [[nodiscard]] double tau_end() const { return slip.tau_end; }
  [[nodiscard]] bool resticks() const { return slip.resticks; }
  /// Spring force above the level at tau = 0 of the stick after the slip.
  [[nodiscard]] double intercept() const { return after.intercept; }
  /// Returns the force of the stick before the slip as the sensor shows it, continued to tau = 0; `shown_after` returns
  /// that of the stick after it.
  [[nodiscard]] double shown_before() const { return before_slip(0.0).z; }
  [[nodiscard]] double shown_after() const { return after_slip(0.0).z; }

  /// Force above the level in units of k V / w_n, at any tau = w_n (t - onset).
  [[nodiscard]] Point at(double tau) const {
    const double reach = 0.5 * sensor_.average_tau;
    if (tau <= -reach) return before_slip(tau);
    if (tau > slip.tau_end + reach && sensor_.lag_tau == 0.0) return after_slip(tau);
    if (filtered_) {
      const ShownPoint p = filtered_->at(tau);
      return {p.z, p.d_z0, p.d_zeta, p.d_tau, p.d_log_omega, p.d_log_average};
    }
    if (averaged_) return averaged_->at(tau);
    const double decay = std::exp(-slip.zeta * tau);
    return in_slip(tau, decay * std::cos(slip.b * tau), decay * std::sin(slip.b * tau));
  }
  /// Returns a point of the straight stick before the slip; `after_slip` returns one of the stick after it.
  [[nodiscard]] Point before_slip(double tau) const { return as_shown({slip.z0 + tau, 1.0, 0.0, 1.0}); }
  [[nodiscard]] Point after_slip(double tau) const {
    return as_shown({after.intercept + tau, after.d_z0, after.d_zeta, 1.0});
  }

  /// Derivatives of the force with respect to the law's coordinates, of the point's.
  [[nodiscard]] static std::array<double, 1> by_law(const Point& point) { return {point.d_zeta}; }
  /// Returns the derivative of the force with respect to ln w_n at fixed tau; `by_log_sensor` returns the part of it
  /// that comes from the times of the sensor.
  [[nodiscard]] static double by_log_omega(const Point& point) { return point.d_log_omega; }
  [[nodiscard]] static double by_log_sensor(const Point& point) { return point.d_log_omega; }

  /// The cycle at samples in ascending order. At even steps (`step_tau`; 0: uneven), of which some may be left out, a
  /// slip's cosine and sine turn by the same angle from sample to sample.
  class Samples {
   public:
    Samples(const CoulombCycle& cycle, double step_tau)
        : cycle_(cycle),
          turns_evenly_(step_tau > 0.0 && !cycle.filtered_),
          step_tau_(step_tau),
          begin_(cycle.slip.zeta, cycle.slip.b, step_tau),
          end_(begin_) {}

    Point at(double tau) {
      const double reach = 0.5 * cycle_.sensor_.average_tau;
      if (!turns_evenly_ || !(tau > -reach) || !(tau <= cycle_.slip.tau_end + reach)) return cycle_.at(tau);
      const bool is_next = tau < next_tau_ + 0.5 * step_tau_;
      next_tau_ = tau + step_tau_;
      const auto move = [is_next](model::Phasor& phasor, double to) { is_next ? phasor.step() : phasor.start(to); };
      move(begin_, tau - reach);
      if (!cycle_.averaged_) return cycle_.in_slip(tau, begin_.c(), begin_.s());
      move(end_, tau + reach);
      return cycle_.averaged_->at(tau, begin_, end_);
    }

   private:
    const CoulombCycle& cycle_;
    bool turns_evenly_;
    double step_tau_;
    double next_tau_ = -std::numeric_limits<double>::infinity();
    model::Phasor begin_, end_;  ///< of the average
  };

 private:
  /// Returns a point of the slip from c = exp(-zeta tau) cos b tau and bs = exp(-zeta tau) sin b tau.
  [[nodiscard]] Point in_slip(double tau, double c, double bs) const {
    const double s = bs / slip.b;
    return is_transmitted_ ? model::transmitted_wave(slip, tau, c, s) : model::slip_wave(slip, tau, c, s);
  }

  /// A straight ramp lags by the delay of the filter.
  [[nodiscard]] Point as_shown(Point stick) const {
    if (is_transmitted_) {
      stick.z += 2.0 * slip.zeta;
      stick.d_zeta += 2.0;
    }
    stick.z -= sensor_.lag_tau;
    stick.d_log_omega -= sensor_.lag_tau;
    return stick;
  }

  Sensor sensor_;
  bool is_transmitted_;
  std::optional<ShownMotion<CoulombMotion>> filtered_;  ///< where the sensor filters
  std::optional<AveragedSlip> averaged_;                ///< where it averages, without a filter
};

}  // namespace slipfit::fit
