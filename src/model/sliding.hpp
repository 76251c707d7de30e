#pragma once

#include <ceres/jet.h>

#include <cmath>
#include <optional>

#include "model/ageing.hpp"
#include "model/relaxing.hpp"
#include "model/reloading.hpp"
#include "model/slip.hpp"
#include "model/slip_jets.hpp"
#include "model/velocity_units.hpp"

namespace slipfit::model {

/// One period of stick-slip; forces of the spring above F_k(0+).
template <class Number>
struct SlidingCycle {
  Number slip_s, stick_s, peak_N, trough_N;

  [[nodiscard]] Number period_s() const { return slip_s + stick_s; }
};

/// The rise of the force after a slip, A and l. docs/model.md (25)
template <class Number>
struct RiseOf {
  Number force_N, length_m;
};

/// The share of k that relaxes, and the time in which it does. docs/model.md (25c)
template <class Number>
struct RelaxationOf {
  Number share, time_s;
};

/// Static friction that grows with the stick time: AgeingLawOf without F_s - F_k(0+).
template <class Number>
struct AgeingOf {
  Number rate_N, cutoff_s;
  double reference_s = 1.0;
};

/// A body that is driven over a surface at one speed, in SI: rig and contact as they are at that speed and load. All
/// that a fit or a prediction asks of its motion. The numbers are jets (ceres::Jet), so that every answer has the
/// derivatives of the parameters.
template <class Number>
struct SlidingBody {
  double speed_m_per_s = 1.0;
  Number stiffness_N_per_m{1.0}, omega_rad_per_s{1.0}, zeta{0.0};
  Number difference_N{0.0};                         ///< F_s - F_k(0+), after the reference stick where it ages
  Number slope_N_s_per_m{0.0}, alpha_s_per_m{0.0};  ///< of F_k(v) (docs/model.md section 5); 0: Coulomb friction
  std::optional<AgeingOf<Number>> ageing{};
  std::optional<RiseOf<Number>> rise{};
  std::optional<RelaxationOf<Number>> relaxation{};

  /// Returns lambda, w_n (F_s - F_k(0+)) / (k V), [Paper] eq. (9).
  [[nodiscard]] Number lambda() const { return omega_rad_per_s * difference_N / (stiffness_N_per_m * speed_m_per_s); }

  /// Returns the limit cycle of slips that start from `difference_N`; it is empty where the body does not stick again.
  [[nodiscard]] std::optional<SlidingCycle<Number>> cycle() const {
    std::optional<SlidingCycle<Number>> cycle = straight_cycle();
    if (!cycle || !rise) return cycle;
    const Number stick_m = reloaded_stick_m(Number(speed_m_per_s * cycle->stick_s),
                                            Number(rise->force_N / stiffness_N_per_m), rise->length_m);
    cycle->stick_s = stick_m / speed_m_per_s;
    return cycle;
  }

  /// Returns whether the body has stick-slip; where static friction ages with that of the limit cycle, to a share of
  /// `sharp`.
  [[nodiscard]] bool sticks(double sharp = kSharpDifference) const {
    if (ageing) return aged(sharp).has_value();
    if (!(difference_N.a > 0.0) || !(std::abs(zeta.a) < 1.0)) return false;
    const double z0 = lambda().a - 2.0 * zeta.a;
    if (relaxation) {
      return relaxing_repeats(z0, zeta.a, relaxation->share.a, omega_rad_per_s.a * relaxation->time_s.a);
    }
    if (!depends_on_speed()) return SpiralEnd(z0, zeta.a).resticks();
    const auto track = slip().solve();
    return track && track->resticks();
  }

  /// Returns F_s - F_k(0+) of the limit cycle: `difference_N` or, where static friction ages, that after its sticks, to
  /// a share of `sharp`; empty where it ages and there is no such cycle.
  [[nodiscard]] std::optional<Number> aged_difference_N(double sharp = kSharpDifference) const {
    if (!ageing) return difference_N;
    const std::optional<Aged> found = aged(sharp);
    if (!found) return std::nullopt;
    SlidingBody held = *this;
    held.difference_N = Number(found->difference_N);
    const auto cycle = held.cycle();
    if (!cycle) return std::nullopt;  // found roughly, next to the end of stick-slip
    return model::aged_difference_N(
        found->difference_N, AgeingLawOf<Number>{difference_N, ageing->rate_N, ageing->reference_s, ageing->cutoff_s},
        cycle->stick_s, found->stick_by_difference_s_per_N);
  }

  /// Returns zeta of small swings around steady sliding, which is unstable where it is below 0: friction law linearised
  /// at the driving speed, its tangent and not its chord (docs/model.md section 5).
  [[nodiscard]] Number total_damping_ratio() const {
    if (relaxation) return in_slip().zeta;
    return zeta + 0.5 * slip().slope * exp(slip().rate);
  }

  /// Returns a number that is positive where the body sticks and nearly linear in the parameters up to where it
  /// vanishes; empty where it is not known.
  [[nodiscard]] std::optional<Number> restick_margin() const {
    if (depends_on_speed()) {
      const SlipJets<Number> jets = slip();
      const auto track = jets.solve();
      return track ? std::optional(jets.restick_margin(*track)) : std::nullopt;
    }
    const SlidingBody oscillator = in_slip();
    if (!(oscillator.zeta.a < 1.0)) return std::nullopt;
    return model::restick_margin(oscillator.lambda(), oscillator.zeta);
  }

  [[nodiscard]] Regime regime(bool has_cycle) const { return regime_of(total_damping_ratio().a, has_cycle); }

 private:
  template <class>
  friend struct SlidingBody;

  /// F_s - F_k(0+) of the limit cycle, and the derivative of its stick by it.
  struct Aged {
    double difference_N = 0.0, stick_by_difference_s_per_N = 0.0;
  };
  [[nodiscard]] std::optional<Aged> aged(double sharp) const {
    using Value = ceres::Jet<double, 1>;
    SlidingBody<Value> held = without_derivatives<Value>();
    double by_difference = 0.0;
    const std::optional<double> solution_N = model::aged_difference_N(
        {difference_N.a, ageing->rate_N.a, ageing->reference_s, ageing->cutoff_s.a},
        [&](double held_N) -> std::optional<StickTime> {
          held.difference_N = Value(held_N, 0);
          const auto cycle = held.cycle();
          if (!cycle) return std::nullopt;
          by_difference = cycle->stick_s.v[0];
          return StickTime{cycle->stick_s.a, by_difference};
        },
        sharp);
    return solution_N ? std::optional(Aged{*solution_N, by_difference}) : std::nullopt;
  }

  [[nodiscard]] bool depends_on_speed() const { return slope_N_s_per_m.a != 0.0 || alpha_s_per_m.a != 0.0; }
  [[nodiscard]] SlipJets<Number> slip() const {
    return {stiffness_N_per_m, omega_rad_per_s, zeta, difference_N, slope_N_s_per_m, alpha_s_per_m, speed_m_per_s};
  }

  /// The body whose slip resembles that of this one, on a spring that does not relax.
  [[nodiscard]] SlidingBody in_slip() const {
    SlidingBody body = *this;
    if (!relaxation) return body;
    const auto [omega, damping] =
        relaxed_oscillator(zeta, relaxation->share, Number(omega_rad_per_s * relaxation->time_s));
    body.stiffness_N_per_m *= omega * omega;
    body.omega_rad_per_s *= omega;
    body.zeta = damping;
    body.relaxation.reset();
    return body;
  }

  /// Returns the limit cycle without the rise after slips.
  [[nodiscard]] std::optional<SlidingCycle<Number>> straight_cycle() const {
    if (!(difference_N.a > 0.0) || !(std::abs(zeta.a) < 1.0)) return std::nullopt;
    const SlipJets<Number> jets = slip();
    std::optional<ScaledCycle<Number>> scaled;
    if (relaxation) {
      scaled = relaxing_cycle(jets.z0);
    } else if (depends_on_speed()) {
      const auto track = jets.solve();
      if (track) scaled = jets.cycle(*track);
    } else {
      scaled = coulomb_cycle(jets.z0, zeta);
    }
    if (!scaled) return std::nullopt;
    return SlidingCycle<Number>{scaled->slip / omega_rad_per_s, scaled->stick / omega_rad_per_s,
                                scaled->peak * jets.force_unit_N, scaled->trough * jets.force_unit_N};
  }

  [[nodiscard]] std::optional<ScaledCycle<Number>> relaxing_cycle(const Number& z0) const {
    const Number time = omega_rad_per_s * relaxation->time_s;
    const std::optional<RelaxingPeriod> found = relaxing_period(z0.a, zeta.a, relaxation->share.a, time.a);
    if (!found) return std::nullopt;
    const auto of = [&](const RelaxingSlip::Column& column) {
      Number value(column[0]);
      value.v = column[1] * z0.v + column[2] * zeta.v + column[3] * relaxation->share.v + column[4] * time.v;
      return value;
    };
    const Number slip = of(found->slip);
    return ScaledCycle<Number>{slip, of(found->period) - slip, z0, of(found->trough)};
  }

  template <class Value>
  [[nodiscard]] SlidingBody<Value> without_derivatives() const {
    SlidingBody<Value> body{speed_m_per_s,         Value(stiffness_N_per_m.a), Value(omega_rad_per_s.a), Value(zeta.a),
                            Value(difference_N.a), Value(slope_N_s_per_m.a),   Value(alpha_s_per_m.a)};
    if (rise) body.rise = {Value(rise->force_N.a), Value(rise->length_m.a)};
    if (relaxation) body.relaxation = {Value(relaxation->share.a), Value(relaxation->time_s.a)};
    return body;
  }
};

}  // namespace slipfit::model
