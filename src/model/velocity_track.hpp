#pragma once

#include <optional>
#include <vector>

#include "model/slip_series.hpp"
#include "model/velocity_law.hpp"

namespace slipfit::model {

struct SlipNode;

/// Spring force above F_k(0+) in units of k V / w_n with its derivatives at fixed tau: WavePoint (slip.hpp) with two
/// derivatives more.
struct TrackPoint {
  double z = 0.0, d_tau = 0.0, d_z0 = 0.0, d_zeta = 0.0, d_slope = 0.0, d_rate = 0.0;
};

/// A value and its derivatives at fixed tau.
struct TrackValue {
  double value = 0.0, d_z0 = 0.0, d_zeta = 0.0, d_slope = 0.0, d_rate = 0.0;
};

/// Describes the end of the slip: z' = 1 where it sticks again, else z'' = 0.
struct TrackEnd {
  double tau = 0.0;
  TrackValue first, second;  ///< z', z''
  double third = 0.0;        ///< z'''
};

/// One cycle with friction that depends on the sliding speed, for fits: the slip of velocity_slip.hpp to 1e-7, with its
/// derivatives, at any time. In z = s - 2 zeta:
///   z'' + 2 zeta z' + z = g(v) = slope (exp(rate v) - 1) / rate,  v = 1 - z',  z(0) = z0, z'(0) = 1
/// (docs/model.md section 5): slope = b w_n / k with b the slope of F_k(v) at v = 0, rate = alpha V. At rate 0 friction
/// is linear in the speed and adds slope / 2 to zeta. The slip ends where z' = 1 again or, where it does not stick, at
/// its smallest sliding speed, as Slip does.
class VelocityTrack {
 public:
  /// Solves the slip. It is empty where the slip has no start (z0 + 2 zeta <= 0), is not finite, runs away, settles
  /// without turning back, or is stiffer than any that a recording shows: friction that grows by more than exp(10)
  /// within the slip.
  static std::optional<VelocityTrack> solve(double z0, double zeta, double slope, double rate) {
    return solve(z0, zeta, ScaledLaw{slope, rate});
  }
  static std::optional<VelocityTrack> solve(double z0, double zeta, const ScaledLaw& law);

  /// The whole cycle: tau < 0 is the stick before, tau > tau_end() the stick after.
  [[nodiscard]] TrackPoint at(double tau) const;
  /// Returns the force that spring and damper carry together, z + 2 zeta z'.
  [[nodiscard]] TrackPoint transmitted_at(double tau) const;
  /// Returns the integral of what `at` gives, and of its derivatives, from the onset to any time; `d_tau` is z itself.
  [[nodiscard]] TrackPoint integral_to(double tau) const;
  /// Returns the same integral of what `transmitted_at` gives.
  [[nodiscard]] TrackPoint transmitted_integral_to(double tau) const;
  [[nodiscard]] bool resticks() const { return resticks_; }
  [[nodiscard]] double tau_end() const { return end_.tau; }
  /// The parts of the slip, of what `at` or `transmitted_at` gives.
  [[nodiscard]] std::vector<SlipPart> parts(bool transmitted) const;
  /// The begin of the part in which the slip is fastest at its begin.
  [[nodiscard]] double fastest_tau() const;
  /// After the slip z = value + tau.
  [[nodiscard]] const TrackValue& after() const { return after_; }
  [[nodiscard]] const TrackEnd& end() const { return end_; }

 private:
  struct Step {
    double begin = 0.0;
    double integral = 0.0;            ///< of s from the onset to the begin
    ScaledGradient integral_of_ds{};  ///< of its derivatives
    SlipSeries<true> series;
  };

  void keep(const SlipNode& begin, const SlipSeries<true>& series);
  void finish(const SlipNode& end);
  [[nodiscard]] const Step& step_at(double tau) const;
  [[nodiscard]] TrackPoint inside(double tau) const;
  [[nodiscard]] TrackPoint slope_inside(double tau) const;

  ScaledSlip slip_;
  bool resticks_ = false;
  TrackValue after_;
  TrackEnd end_;
  std::vector<Step> steps_;
};

}  // namespace slipfit::model
