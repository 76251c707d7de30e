#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "fit/cycle/cycle_data.hpp"
#include "fit/observation/lagged_track.hpp"
#include "model/velocity_track.hpp"

namespace slipfit::fit {

inline model::LawShape shape_of(FrictionLaw law) {
  if (law == FrictionLaw::Hyperbolic) return model::LawShape::Hyperbolic;
  return law == FrictionLaw::Logarithmic ? model::LawShape::Logarithmic : model::LawShape::Exponential;
}

/// b / (2 sqrt(k m)) over the coordinate kFrictionSlope, b v_c / (F_k(v_c) - F_k(0+)), and its derivative by a.
struct SlopeRatio {
  double value = 1.0;
  double derivative = -0.5;
};

inline SlopeRatio slope_ratio(FrictionLaw law, double a) {
  const model::ExcessFriction mean = model::ScaledLaw{1.0, a, shape_of(law)}.at(1.0);
  return {1.0 / mean.value, -mean.d_rate / (mean.value * mean.value)};
}

/// One cycle under friction that depends on the sliding speed, as the sensor shows it, in the units of
/// model/velocity_track.hpp: integrated.
class SpeedDependentCycle {
 public:
  using Point = ShownPoint;

  /// Empty where the slip has no solution.
  static std::optional<SpeedDependentCycle> solve(double z0, const Coordinates& values, const SensorTimes& sensor,
                                                  const Scales& scales) {
    const double rate_unit = scales.speed_m_per_s / scales.population->slip_speed_m_per_s;
    const double slope_unit = 2.0 * scales.population->load;
    const SlopeRatio ratio = slope_ratio(scales.law, values(kFrictionRate));
    const model::ScaledLaw law{slope_unit * values(kFrictionSlope) * ratio.value, rate_unit * values(kFrictionRate),
                               shape_of(scales.law)};
    auto track = model::VelocityTrack::solve(z0, values(kDamping), law);
    if (!track) return std::nullopt;
    SpeedDependentCycle cycle(std::move(*track), scales.view);
    const double omega_rad_per_s = std::exp(values(kLogFrequency));
    if (sensor.lag_s > 0.0) {
      cycle.lagged_.emplace(cycle.track_, scales.view == ForceView::Transmitted, omega_rad_per_s * sensor.lag_s);
    }
    cycle.half_window_ = 0.5 * omega_rad_per_s * sensor.average_s;
    cycle.by_slope_ = slope_unit * ratio.value;
    cycle.by_rate_ = slope_unit * values(kFrictionSlope) * ratio.derivative;
    cycle.rate_unit_ = rate_unit;
    return cycle;
  }

  /// Force above the level in units of k V / w_n, at any tau = w_n (t - onset).
  [[nodiscard]] Point at(double tau) const {
    // The mean of a straight line is its middle.
    const bool is_straight = tau + half_window_ <= 0.0 || (!lagged_ && tau - half_window_ >= track_.tau_end());
    return half_window_ == 0.0 || is_straight ? shown_at(tau) : mean_around(tau);
  }
  [[nodiscard]] Point before_slip(double tau) const { return at(tau); }
  [[nodiscard]] Point after_slip(double tau) const { return at(tau); }

  /// Derivatives of the force with respect to the law's coordinates, of the point's.
  [[nodiscard]] std::array<double, 3> by_law(const Point& point) const {
    return {point.d_zeta, by_slope_ * point.d_slope, rate_unit_ * point.d_rate + by_rate_ * point.d_slope};
  }
  /// At fixed tau, and the part of that by the times of the sensor.
  [[nodiscard]] static double by_log_omega(const Point& point) { return point.d_log_omega; }
  [[nodiscard]] static double by_log_sensor(const Point& point) { return point.d_log_omega; }

  /// The cycle at samples in ascending order.
  class Samples {
   public:
    Samples(const SpeedDependentCycle& cycle, double /*step_tau*/) : cycle_(cycle) {}
    [[nodiscard]] Point at(double tau) const { return cycle_.at(tau); }

   private:
    const SpeedDependentCycle& cycle_;
  };

 private:
  SpeedDependentCycle(model::VelocityTrack track, ForceView view) : track_(std::move(track)), view_(view) {}

  [[nodiscard]] model::TrackPoint instant_at(double tau) const {
    return view_ == ForceView::Transmitted ? track_.transmitted_at(tau) : track_.at(tau);
  }

  /// The force as the sensor would show it without its average.
  [[nodiscard]] Point shown_at(double tau) const { return lagged_ ? lagged_->at(track_, tau) : Point{instant_at(tau)}; }

  /// The mean over the window around tau.
  [[nodiscard]] Point mean_around(double tau) const {
    const double first = tau - half_window_;
    const double last = tau + half_window_;
    const double length = last - first;
    const Point shown_first = shown_at(first);
    const Point shown_last = shown_at(last);
    Point mean{integral_to(last)};
    add(integral_to(first), -1.0, mean);
    if (lagged_) {
      // y' = kappa (z - y) makes the integral of y that of z less y / kappa.
      const double lag_tau = lagged_->lag_tau();
      add(shown_last, -lag_tau, mean);
      add(shown_first, lag_tau, mean);
      mean.d_log_omega = -lag_tau * (shown_last.d_log_omega - shown_first.d_log_omega + shown_last.z - shown_first.z);
    }
    for (double* const value : {&mean.z, &mean.d_z0, &mean.d_zeta, &mean.d_slope, &mean.d_rate, &mean.d_log_omega}) {
      *value /= length;
    }
    mean.d_tau = (shown_last.z - shown_first.z) / length;
    mean.d_log_average = 0.5 * (shown_first.z + shown_last.z) - mean.z;
    mean.d_log_omega += mean.d_log_average;  // the window is w_n W long
    return mean;
  }

  [[nodiscard]] model::TrackPoint integral_to(double tau) const {
    return view_ == ForceView::Transmitted ? track_.transmitted_integral_to(tau) : track_.integral_to(tau);
  }

  static void add(const model::TrackPoint& point, double weight, model::TrackPoint& sum) {
    sum.z += weight * point.z;
    sum.d_z0 += weight * point.d_z0;
    sum.d_zeta += weight * point.d_zeta;
    sum.d_slope += weight * point.d_slope;
    sum.d_rate += weight * point.d_rate;
  }

  model::VelocityTrack track_;
  ForceView view_;
  std::optional<LaggedTrack> lagged_;  ///< where the sensor lags
  double half_window_ = 0.0;           ///< of the sensor's average, in tau
  double by_slope_ = 0.0;              ///< d (scaled slope) / d kFrictionSlope
  double by_rate_ = 0.0;               ///< d (scaled slope) / d kFrictionRate
  double rate_unit_ = 1.0;
};

}  // namespace slipfit::fit
