#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "fit/cycle/cycle_data.hpp"
#include "fit/cycle/sensor.hpp"
#include "fit/cycle/shown_motion.hpp"
#include "model/slip.hpp"
#include "model/weakening.hpp"

namespace slipfit::fit {

/// A cycle under Coulomb friction in its view, without a sensor, in the units of model/slip.hpp: closed form.
class CoulombWave {
 public:
  /// Radians: a search far from any slip may try one that hardly ends, or has no end.
  static constexpr double kLongest = 1e3;

  /// `z0`: spring force above F_k at the onset. Needs z0 + 2 zeta > 0 and |zeta| < 1.
  CoulombWave(double z0, double zeta, ForceView view)
      : slip(model::solve_slip(z0, zeta)),
        after(model::stick_after(slip)),
        is_transmitted(view == ForceView::Transmitted) {}

  model::Slip slip;
  model::StickLine after;
  bool is_transmitted;

  [[nodiscard]] model::WavePoint at(double tau) const {
    if (tau <= 0.0) return before_slip(tau);
    if (tau > slip.tau_end) return after_slip(tau);
    const double decay = std::exp(-slip.zeta * tau);
    return in_slip(tau, decay * std::cos(slip.b * tau), decay * std::sin(slip.b * tau));
  }
  /// Returns a point of the straight stick before the slip; `after_slip` returns one of the stick after it.
  [[nodiscard]] model::WavePoint before_slip(double tau) const { return in_stick({slip.z0 + tau, 1.0, 0.0, 1.0}); }
  [[nodiscard]] model::WavePoint after_slip(double tau) const {
    return in_stick({after.intercept + tau, after.d_z0, after.d_zeta, 1.0});
  }
  /// Returns a point of the slip from c = exp(-zeta tau) cos b tau and bs = exp(-zeta tau) sin b tau.
  [[nodiscard]] model::WavePoint in_slip(double tau, double c, double bs) const {
    const double s = bs / slip.b;
    return is_transmitted ? model::transmitted_wave(slip, tau, c, s) : model::slip_wave(slip, tau, c, s);
  }

 private:
  [[nodiscard]] model::WavePoint in_stick(model::WavePoint spring) const {
    if (is_transmitted) {
      spring.z += 2.0 * slip.zeta;
      spring.d_zeta += 2.0;
    }
    return spring;
  }
};

/// The same cycle as ShownMotion takes it. The law has no numbers.
class CoulombMotion {
 public:
  static constexpr bool kStraightSticks = true;

  explicit CoulombMotion(const CoulombWave& wave)
      : wave_(wave), force_(wave.slip, wave.after, kAnyAverage, wave.is_transmitted) {}

  [[nodiscard]] MotionPoint at(double tau) const {
    const model::WavePoint p = wave_.at(tau);
    return {p.z, p.d_tau, p.d_z0, p.d_zeta};
  }
  [[nodiscard]] MotionPoint integral_to(double tau) const { return force_.integral_to(tau); }
  [[nodiscard]] double tau_end() const { return wave_.slip.tau_end; }
  /// Returns the parts of the slip; none of one that does not end within CoulombWave::kLongest.
  [[nodiscard]] std::vector<model::SlipPart> parts() const;

 private:
  static constexpr double kAnyAverage = 1.0;  ///< integrals do not depend on it

  CoulombWave wave_;
  AveragedSlip force_;
};

/// One cycle under Coulomb friction as the sensor shows it.
class CoulombCycle {
 public:
  using Point = model::WavePoint;
  static constexpr bool kStraightSticks = true;

  /// `z0`, `zeta`: as for CoulombWave.
  CoulombCycle(double z0, double zeta, const Sensor& sensor, ForceView view) : wave(z0, zeta, view), sensor_(sensor) {
    if (sensor.lag_tau > 0.0) {
      filtered_.emplace(CoulombMotion(wave), sensor);
    } else if (sensor.average_tau > 0.0) {
      averaged_.emplace(wave.slip, wave.after, sensor.average_tau, wave.is_transmitted);
    }
  }

  CoulombWave wave;

  [[nodiscard]] double tau_end() const { return wave.slip.tau_end; }
  [[nodiscard]] bool resticks() const { return wave.slip.resticks; }
  /// Spring force above the level at tau = 0 of the stick after the slip.
  [[nodiscard]] double intercept() const { return wave.after.intercept; }

  /// Force above the level in units of k V / w_n, at any tau = w_n (t - onset).
  [[nodiscard]] Point at(double tau) const {
    const double reach = 0.5 * sensor_.average_tau;
    if (tau <= -reach) return before_slip(tau);
    if (tau > tau_end() + reach && sensor_.lag_tau == 0.0) return after_slip(tau);
    if (filtered_) {
      const ShownPoint p = filtered_->at(tau);
      return {p.z, p.d_z0, p.d_zeta, p.d_tau, p.d_log_omega, p.d_log_average};
    }
    return averaged_ ? averaged_->at(tau) : wave.at(tau);
  }
  /// Returns a point of the straight stick before the slip; `after_slip` returns one of the stick after it.
  [[nodiscard]] Point before_slip(double tau) const { return delayed(wave.before_slip(tau)); }
  [[nodiscard]] Point after_slip(double tau) const { return delayed(wave.after_slip(tau)); }

  /// Derivatives of the force with respect to the law's coordinates, of the point's.
  [[nodiscard]] static std::array<double, 1> by_law(const Point& point) { return {point.d_zeta}; }
  /// Returns the derivative of the force with respect to ln w_n at fixed tau.
  [[nodiscard]] static double by_log_omega(const Point& point) { return point.d_log_omega; }

  /// The cycle at samples in ascending order. At even steps (`step_tau`; 0: uneven), of which some may be left out, a
  /// slip's cosine and sine turn by the same angle from sample to sample.
  class Samples {
   public:
    Samples(const CoulombCycle& cycle, double step_tau)
        : cycle_(cycle),
          turns_evenly_(step_tau > 0.0 && !cycle.filtered_),
          step_tau_(step_tau),
          begin_(cycle.wave.slip.zeta, cycle.wave.slip.b, step_tau),
          end_(begin_) {}

    Point at(double tau) {
      const double reach = 0.5 * cycle_.sensor_.average_tau;
      if (!turns_evenly_ || !(tau > -reach) || !(tau <= cycle_.tau_end() + reach)) return cycle_.at(tau);
      const bool is_next = tau < next_tau_ + 0.5 * step_tau_;
      next_tau_ = tau + step_tau_;
      const auto move = [is_next](model::Phasor& phasor, double to) { is_next ? phasor.step() : phasor.start(to); };
      move(begin_, tau - reach);
      if (!cycle_.averaged_) return cycle_.wave.in_slip(tau, begin_.c(), begin_.s());
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
  /// A straight ramp lags by the delay of the filter.
  [[nodiscard]] Point delayed(Point stick) const {
    stick.z -= sensor_.lag_tau;
    stick.d_log_omega -= sensor_.lag_tau;
    return stick;
  }

  Sensor sensor_;
  std::optional<ShownMotion<CoulombMotion>> filtered_;  ///< where the sensor filters
  std::optional<AveragedSlip> averaged_;                ///< where it averages, without a filter
};

}  // namespace slipfit::fit
