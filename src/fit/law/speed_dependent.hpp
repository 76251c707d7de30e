#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "fit/cycle/cycle_data.hpp"
#include "fit/cycle/shown_motion.hpp"
#include "model/velocity_slip.hpp"

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

/// A slip under friction that depends on the sliding speed, integrated, in a view. The numbers of the law are its slope
/// and its rate.
class SpeedDependentMotion {
 public:
  static constexpr bool kStraightSticks = true;

  SpeedDependentMotion(model::VelocityTrack track, ForceView view)
      : track_(std::move(track)), is_transmitted_(view == ForceView::Transmitted) {}

  [[nodiscard]] MotionPoint at(double tau) const {
    return point_of(is_transmitted_ ? track_.transmitted_at(tau) : track_.at(tau));
  }
  [[nodiscard]] MotionPoint integral_to(double tau) const {
    return point_of(is_transmitted_ ? track_.transmitted_integral_to(tau) : track_.integral_to(tau));
  }
  [[nodiscard]] double tau_end() const { return track_.tau_end(); }
  [[nodiscard]] std::vector<model::SlipPart> parts() const { return track_.parts(is_transmitted_); }

 private:
  static MotionPoint point_of(const model::TrackPoint& p) {
    return {p.z, p.d_tau, p.d_z0, p.d_zeta, {p.d_slope, p.d_rate}};
  }

  model::VelocityTrack track_;
  bool is_transmitted_;
};

/// One cycle under friction that depends on the sliding speed, as the sensor shows it, in the units of
/// model/velocity_slip.hpp: integrated.
class SpeedDependentCycle {
 public:
  using Point = ShownPoint;
  static constexpr bool kStraightSticks = true;

  /// Solves the cycle; it is empty where the slip has no solution.
  static std::optional<SpeedDependentCycle> solve(double z0, const Coordinates& values, const SensorTimes& sensor,
                                                  const Scales& scales) {
    const double rate_unit = scales.speed_m_per_s / scales.population->slip_speed_m_per_s;
    const double slope_unit = 2.0 * scales.population->load;
    const SlopeRatio ratio = slope_ratio(scales.law, values(kFrictionRate));
    const model::ScaledLaw law{slope_unit * values(kFrictionSlope) * ratio.value, rate_unit * values(kFrictionRate),
                               shape_of(scales.law)};
    auto track = model::VelocityTrack::solve(z0, values(kDamping), law);
    if (!track) return std::nullopt;
    const double omega_rad_per_s = std::exp(values(kLogFrequency));
    SpeedDependentCycle cycle({SpeedDependentMotion(*std::move(track), scales.view), sensor.in_tau(omega_rad_per_s)});
    cycle.by_slope_ = slope_unit * ratio.value;
    cycle.by_rate_ = slope_unit * values(kFrictionSlope) * ratio.derivative;
    cycle.rate_unit_ = rate_unit;
    return cycle;
  }

  /// Force above the level in units of k V / w_n, at any tau = w_n (t - onset).
  [[nodiscard]] Point at(double tau) const { return shown_.at(tau); }
  [[nodiscard]] Point before_slip(double tau) const { return at(tau); }
  [[nodiscard]] Point after_slip(double tau) const { return at(tau); }

  /// Derivatives of the force with respect to the law's coordinates, of the point's.
  [[nodiscard]] std::array<double, 3> by_law(const Point& point) const {
    return {point.d_zeta, by_slope_ * point.d_law[0], rate_unit_ * point.d_law[1] + by_rate_ * point.d_law[0]};
  }
  /// Returns the derivative of the force with respect to ln w_n at fixed tau.
  [[nodiscard]] static double by_log_omega(const Point& point) { return point.d_log_omega; }

  using Samples = SamplesOneByOne<SpeedDependentCycle>;

 private:
  explicit SpeedDependentCycle(ShownMotion<SpeedDependentMotion> shown) : shown_(std::move(shown)) {}

  ShownMotion<SpeedDependentMotion> shown_;
  double by_slope_ = 0.0;  ///< d (scaled slope) / d kFrictionSlope
  double by_rate_ = 0.0;   ///< d (scaled slope) / d kFrictionRate
  double rate_unit_ = 1.0;
};

}  // namespace slipfit::fit
