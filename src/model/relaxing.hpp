#pragma once

#include <ceres/jet.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "model/root_between.hpp"
#include "model/slip_series.hpp"
#include "model/weakening.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit::model {

/// Returns what a spring that relaxes in the time t_r regains in a stick, A / (s k V t_r) of docs/model.md (25b), where
/// slips repeat: the spring is moved back by V times the period in each slip, along half a period of a cosine.
/// `period`, `slip`: times over t_r, above 0. Numbers, or jets of them.
template <class Number>
Number regained_in_stick(const Number& period, const Number& slip) {
  using std::exp;
  constexpr double kPi2 = std::numbers::pi * std::numbers::pi;
  const Number lasting = 0.5 * kPi2 * (1.0 + exp(-slip)) / (slip * slip + kPi2);  // 1 where nothing relaxes in a slip
  return period * lasting / (1.0 - exp(-period));
}

/// Holds the oscillator of the complex roots of docs/model.md (25c), which a slip on a spring that relaxes resembles,
/// in units of w_n.
template <class Number>
struct RelaxedOscillator {
  Number omega, zeta;
};
/// Returns that oscillator; `share` is s, and `time`, w_n t_r, is above 0. The share that relaxes dies out at the real
/// root.
template <class Number>
RelaxedOscillator<Number> relaxed_oscillator(const Number& zeta, const Number& share, const Number& time) {
  using std::sqrt;
  const Number second = 2.0 * zeta + 1.0 / time;
  const Number first = 1.0 + 2.0 * zeta / time;
  const Number last = (1.0 - share) / time;
  // The one real root r^3 - second r^2 + first r - last = 0, then a Newton step for its derivatives.
  const auto cubic = [&](const auto& rate) { return ((rate - second) * rate + first) * rate - last; };
  const double root = root_between([&](double rate) { return value_of(cubic(Number(rate))); }, 0.0, value_of(second));
  const Number rate = root - cubic(Number(root)) / value_of(Number((3.0 * root - 2.0 * second) * root + first));
  const Number omega = sqrt(last / rate);
  return {omega, 0.5 * (second - rate) / omega};
}

/// One cycle under Coulomb friction of a body on a spring of which the share s relaxes in the time t_r (standard linear
/// solid, beside the damper), in the units of model/slip.hpp with k and w_n of the spring before it relaxes:
/// x'' = -z - 2 zeta x' in the slip and x' = 1 in the sticks, z' = x' - q / t, q' = s x' - q / t, docs/model.md (25c).
/// Jet: ceres::Jet with the four derivatives, or with one, which stays 0, where they are not wanted.
template <class Jet>
class RelaxingSlipOf {
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
  RelaxingSlipOf(double z0, double zeta, double share, const Times& times, ForceView view = ForceView::Spring);

  /// End of slip; where it never sticks again: the minimum of the sliding speed.
  [[nodiscard]] double tau_end() const { return tau_end_; }
  [[nodiscard]] bool resticks() const { return resticks_; }
  /// Force above F_k at the end of the slip, less tau_end(): the stick that follows, were it straight, at tau = 0.
  [[nodiscard]] double intercept() const { return end_.z.a - tau_end_; }

  /// Returns the force of the spring at the end of the slip.
  [[nodiscard]] double end_force() const { return end_.z.a; }

  /// The force in this view at any tau from the stick before the slip to the stick after it.
  [[nodiscard]] Point at(double tau) const;
  /// The integral of what `at` gives, from the onset to any time; `d_tau` is the force itself.
  [[nodiscard]] Point integral_to(double tau) const;
  /// The parts of the slip and of the stick after it, for three periods, of what `at` gives.
  [[nodiscard]] std::vector<SlipPart> parts() const;

 private:
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

  static constexpr bool kHasDerivatives = Jet::DIMENSION == static_cast<int>(kScaledParameters);
  static Jet parameter(double value, int place) {
    if constexpr (kHasDerivatives) return Jet(value, place);
    return Jet(value);
  }
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
  std::vector<Column> integrals_;  ///< from the onset to the start of each part, and to the end
};

using RelaxingSlip = RelaxingSlipOf<ceres::Jet<double, static_cast<int>(kScaledParameters)>>;
extern template class RelaxingSlipOf<ceres::Jet<double, static_cast<int>(kScaledParameters)>>;

/// Holds the times of slip and period of slips that repeat, and the force at the end of the slip, as RelaxingSlip has
/// them.
struct RelaxingPeriod {
  RelaxingSlip::Column slip{}, period{}, trough{};
};
/// Returns these slips; `time` is w_n t_r. The result is empty where the body does not stick again.
std::optional<RelaxingPeriod> relaxing_period(double z0, double zeta, double share, double time);

/// Returns whether there are such slips.
bool relaxing_repeats(double z0, double zeta, double share, double time);

}  // namespace slipfit::model
