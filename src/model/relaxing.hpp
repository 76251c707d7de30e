#pragma once

#include <ceres/jet.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "model/slip_series.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit::model {

/// What a spring that relaxes in the time t_r regains in a stick, A / (s k V t_r) of docs/model.md (25b), where slips
/// repeat: the spring is moved back by V times the period in each slip, along half a period of a cosine.
/// `period`, `slip`: times over t_r, above 0. Numbers, or jets of them.
template <class Number>
Number regained_in_stick(const Number& period, const Number& slip) {
  using std::exp;
  constexpr double kPi2 = std::numbers::pi * std::numbers::pi;
  const Number lasting = 0.5 * kPi2 * (1.0 + exp(-slip)) / (slip * slip + kPi2);  // 1 where nothing relaxes in a slip
  return period * lasting / (1.0 - exp(-period));
}

/// The oscillator that a slip on a spring which relaxes resembles: that of the complex roots of (25c), in units of w_n.
template <class Number>
struct RelaxedOscillator {
  Number omega, zeta;
};
/// `share`: s; `time`: w_n t_r, above 0. The relaxed share dies out by itself, at the real root.
template <class Number>
RelaxedOscillator<Number> relaxed_oscillator(const Number& zeta, const Number& share, const Number& time) {
  using std::sqrt;
  constexpr int kMostSteps = 60;
  // r^3 + (2 zeta + 1/t) r^2 + (1 + 2 zeta / t) r + (1 - s) / t = 0, r = -rate
  const Number rate_of_spring = 1.0 / time;
  const Number second = 2.0 * zeta + rate_of_spring;
  const Number first = 1.0 + 2.0 * zeta * rate_of_spring;
  const Number last = (1.0 - share) * rate_of_spring;
  Number rate = last / first;
  for (int step = 0; step < kMostSteps; ++step) {
    const Number value = ((second - rate) * rate - first) * rate + last;
    rate = rate - value / ((2.0 * second - 3.0 * rate) * rate - first);
  }
  const Number omega = sqrt(last / rate);
  return {omega, 0.5 * (second - rate) / omega};
}

/// One cycle under Coulomb friction of a body on a spring of which the share s relaxes in the time t_r (standard linear
/// solid, beside the damper), in the units of model/slip.hpp with k and w_n of the spring before it relaxes:
/// x'' = -z - 2 zeta x' in the slip and x' = 1 in the sticks, z' = x' - q / t, q' = s x' - q / t, docs/model.md (25c).
class RelaxingSlip {
 public:
  /// Times in units of 1 / w_n: of relaxation, and of a typical slip and period, from which the force that is still
  /// relaxing at the onset follows.
  struct Times {
    double relaxation = 1.0, slip = 1.0, period = 1.0;
  };
  using Column = std::array<double, 1 + kScaledParameters>;  ///< a value, its derivatives by z0, zeta, s and t
  struct Point {
    Column z{};
    double d_tau = 0.0;
  };

  /// Needs z0 + 2 zeta > 0, |zeta| < 1, 0 <= share < 1 and times above 0.
  RelaxingSlip(double z0, double zeta, double share, const Times& times, ForceView view = ForceView::Spring);

  /// End of slip; where it never sticks again: the minimum of the sliding speed.
  [[nodiscard]] double tau_end() const { return tau_end_; }
  [[nodiscard]] bool resticks() const { return resticks_; }
  /// Force above F_k at the end of the slip, less tau_end(): the stick that follows, were it straight, at tau = 0.
  [[nodiscard]] double intercept() const { return end_.z.a - tau_end_; }

  /// The end of the slip and the force of the spring there.
  [[nodiscard]] Column end_tau() const { return column_of(end_.tau); }
  [[nodiscard]] Column end_force() const { return column_of(end_.z); }

  /// The force in this view at any tau from the stick before the slip to the stick after it.
  [[nodiscard]] Point at(double tau) const;
  /// The integral of what `at` gives, from the onset to any time; `d_tau` is the force itself.
  [[nodiscard]] Point integral_to(double tau) const;
  /// The parts of the slip and of the stick after it, for three periods, of what `at` gives.
  [[nodiscard]] std::vector<SlipPart> parts() const;

 private:
  using Jet = ceres::Jet<double, static_cast<int>(kScaledParameters)>;
  using JetSeries = std::array<Jet, kSeriesOrder + 1>;
  /// A force with its slope.
  struct State {
    Jet z;
    double d_tau = 0.0;
  };
  struct Motion {
    Jet z, speed, relaxing;  ///< z, x' and q
  };
  class Series;
  struct End {
    Jet tau, z, regained;  ///< the last is A of the stick that follows
    Jet integral;          ///< of the force in the view
  };

  static Column column_of(const Jet& jet);
  void slide();
  static Point point_of(const State& state) { return {column_of(state.z), state.d_tau}; }
  [[nodiscard]] Jet drag() const { return view_ == ForceView::Transmitted ? 2.0 * zeta_ : Jet(0.0); }
  void add_part(const Series& series, double begin, double length);
  void end_at(const Series& series, double since);
  [[nodiscard]] std::size_t part_at(double tau) const;
  [[nodiscard]] State before(double tau) const;
  [[nodiscard]] State after(double tau) const;

  Jet z0_, zeta_, share_, time_;
  ForceView view_;
  double stick_tau_;  ///< typical
  Jet regained_;      ///< A of the stick before
  double tau_end_ = 0.0;
  bool resticks_ = false;
  End end_{};
  std::vector<SlipPart> parts_;    ///< of the slip
  std::vector<Column> integrals_;  ///< from the onset to the begin of each part, and to the end
};

/// Slips of one size that repeat: the times of slip and period, and the force at the end of the slip, as RelaxingSlip
/// has them.
struct RelaxingPeriod {
  RelaxingSlip::Column slip{}, period{}, trough{};
};
/// `time`: w_n t_r. Empty where the body does not stick again.
std::optional<RelaxingPeriod> relaxing_period(double z0, double zeta, double share, double time);

/// What has the derivatives of a column, for parameters that are numbers with derivatives themselves.
template <class Number>
Number composed(const RelaxingSlip::Column& column, const Number& z0, const Number& zeta, const Number& share,
                const Number& time) {
  Number result(column[0]);
  result.v = column[1] * z0.v + column[2] * zeta.v + column[3] * share.v + column[4] * time.v;
  return result;
}

}  // namespace slipfit::model
