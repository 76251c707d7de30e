#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "fit/cycle/cycle_data.hpp"
#include "model/velocity_track.hpp"

namespace slipfit::fit {

/// b / (2 sqrt(k m)) over the coordinate kFrictionSlope: a / (exp(a) - 1), and its derivative.
struct SlopeRatio {
  double value = 1.0;
  double derivative = -0.5;
};

inline SlopeRatio slope_ratio(double a) {
  if (std::abs(a) < 1e-4) return {1.0 - 0.5 * a, -0.5 + a / 6.0};  // a^2 / 12 is left out
  const double growth = std::expm1(a);
  return {a / growth, (growth - a * (growth + 1.0)) / (growth * growth)};
}

/// One cycle under friction that depends on the sliding speed, as the sensor shows it, in the units of
/// model/velocity_track.hpp: integrated.
class SpeedDependentCycle {
 public:
  using Point = model::TrackPoint;

  /// Empty where the slip has no solution.
  static std::optional<SpeedDependentCycle> solve(double z0, const double* globals, const Scales& scales) {
    const double rate_unit = scales.speed_m_per_s / scales.population->slip_speed_m_per_s;
    const double slope_unit = 2.0 * scales.population->load;
    const SlopeRatio ratio = slope_ratio(globals[kFrictionRate]);
    auto track = model::VelocityTrack::solve(z0, globals[kDamping], slope_unit * globals[kFrictionSlope] * ratio.value,
                                             rate_unit * globals[kFrictionRate]);
    if (!track) return std::nullopt;
    return SpeedDependentCycle(std::move(*track), scales.view, slope_unit * ratio.value,
                               slope_unit * globals[kFrictionSlope] * ratio.derivative, rate_unit);
  }

  /// Force above the level in units of k V / w_n, at any tau = w_n (t - onset).
  [[nodiscard]] Point at(double tau) const {
    return view_ == ForceView::Transmitted ? track_.transmitted_at(tau) : track_.at(tau);
  }
  [[nodiscard]] Point before_slip(double tau) const { return at(tau); }
  [[nodiscard]] Point after_slip(double tau) const { return at(tau); }

  /// Derivatives of the force with respect to the law's coordinates, of the point's.
  [[nodiscard]] std::array<double, 3> by_law(const Point& point) const {
    return {point.d_zeta, by_slope_ * point.d_slope, rate_unit_ * point.d_rate + by_rate_ * point.d_slope};
  }
  [[nodiscard]] static double by_log_omega(const Point& /*point*/) { return 0.0; }

  /// The cycle at samples in ascending order.
  class Samples {
   public:
    Samples(const SpeedDependentCycle& cycle, double /*step_tau*/) : cycle_(cycle) {}
    [[nodiscard]] Point at(double tau) const { return cycle_.at(tau); }

   private:
    const SpeedDependentCycle& cycle_;
  };

 private:
  SpeedDependentCycle(model::VelocityTrack track, ForceView view, double by_slope, double by_rate, double rate_unit)
      : track_(std::move(track)), view_(view), by_slope_(by_slope), by_rate_(by_rate), rate_unit_(rate_unit) {}

  model::VelocityTrack track_;
  ForceView view_;
  double by_slope_;  ///< d (scaled slope) / d kFrictionSlope
  double by_rate_;   ///< d (scaled slope) / d kFrictionRate
  double rate_unit_;
};

}  // namespace slipfit::fit
