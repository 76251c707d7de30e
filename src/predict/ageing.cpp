#include "predict/motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "model/ageing.hpp"
#include "predict/draws.hpp"

namespace slipfit::predict {
namespace {

/// The row of ModelEstimate's values that holds ln (F_s - F_k(0+)).
constexpr Eigen::Index kDifference = 3;

/// Alpha is in this row of them.
constexpr Eigen::Index kRate = 5;

/// The same bodies, with static friction that does not age.
ModelEstimate held_at(const ModelEstimate& model, double difference_N) {
  ModelEstimate held = model;
  held.ageing.reset();
  held.friction_difference_N = difference_N;
  return held;
}

MotionJets held_motion_at(const ModelEstimate& held, double speed_m_per_s) {
  return held.speed_dependence ? velocity_motion_at(held, speed_m_per_s) : coulomb_motion_at(held, speed_m_per_s);
}

/// Derivative with respect to F_s - F_k(0+), taken out of a jet of `held_at`.
double take_derivative_by_difference(Jet& y, double difference_N) {
  return std::exchange(y.v(kDifference), 0.0) / difference_N;
}

model::AgeingLawOf<Jet> law_of(const ModelEstimate& model) {
  const ModelJets p(model);
  return {p.difference_N, p.ageing_N, model.ageing->reference_stick_s, p.ageing_cutoff_s};
}

/// F_s - F_k(0+) of the limit cycle and its derivatives.
Jet aged_jet(const ModelEstimate& model, double difference_N, Jet stick_s) {
  const double by_difference = take_derivative_by_difference(stick_s, difference_N);
  return model::aged_difference_N(difference_N, law_of(model), stick_s, by_difference);
}

/// The speed at which stick-slip ends, with its derivatives: the static friction after a stick only just reaches the
/// F_s - F_k(0+) that made it so long, and changes with it as fast, so that only the move at F_s - F_k(0+) held counts.
Jet end_speed(const ModelEstimate& model, double difference_N, double speed_m_per_s) {
  ModelEstimate held = held_at(model, difference_N);
  Jet stick_s = held_motion_at(held, speed_m_per_s).cycle->stick_s;
  // Without a rise after slips, w_n times the stick time is a function of lambda, which is as D / V, of alpha V, and of
  // what has no speed in it; with one the path of the stick is a function of what the path would be without.
  held.reloading.reset();
  const Jet straight_s = held_motion_at(held, speed_m_per_s).cycle->stick_s;
  const double straight_by_log_speed =
      -straight_s.v(kDifference) + ModelJets(model).alpha_s_per_m.a * straight_s.v(kRate);
  const double by_straight = stick_s.v(kDifference) / straight_s.v(kDifference);
  const double by_log_speed = by_straight * (straight_s.a + straight_by_log_speed) - stick_s.a;
  take_derivative_by_difference(stick_s, difference_N);
  const Jet excess_N = law_of(model).after(stick_s) - difference_N;
  const double rate_N_per_s = model.ageing->rate_N / (stick_s.a + model.ageing->cutoff_s);
  Jet speed(speed_m_per_s);
  speed.v = -speed_m_per_s * excess_N.v / (rate_N_per_s * by_log_speed);
  return speed;
}

/// Ends of stick-slip are sought between these limits, in units of the speed of a slip.
constexpr double kSlowestEnd = 1e-6;
constexpr double kFastestEnd = 300.0;

double speed_unit(const ModelEstimate& model) {
  return model.natural_frequency_rad_per_s * model.friction_difference_N / model.stiffness_N_per_m;
}

/// Finds the ends of stick-slip of the models that the covariance of one allows. A quantile asks each model only at
/// speeds that may decide on which side of it its end lies, few of them more than twice.
class EndsOfDraws {
 public:
  /// `near_m_per_s`: the end of `model`, where the search begins; 0 or infinite where there is none.
  EndsOfDraws(const ModelEstimate& model, double near_m_per_s)
      : slowest_(kSlowestEnd * speed_unit(model)),
        fastest_(kFastestEnd * speed_unit(model)),
        near_(std::clamp(near_m_per_s, 2.0 * slowest_, 0.5 * fastest_)) {
    for (const ModelEstimate& draw : draws_of(model)) draws_.push_back({draw, 0.0, HUGE_VAL});
  }

  /// To a share of 1e-3. 0 where that model has no stick-slip at any speed, infinite where it has at all.
  [[nodiscard]] double quantile_m_per_s(double share) {
    constexpr double kSharp = 1e-3;
    if (draws_.empty()) return 0.0;
    const auto most_below = static_cast<std::size_t>(share * static_cast<double>(draws_.size() - 1));
    const auto is_above = [&](double speed_m_per_s) { return ending_below(speed_m_per_s) <= most_below; };
    double low = near_;
    double high = near_;
    if (is_above(near_)) {
      for (double step = 2.0; is_above(high); step *= step) {
        if (high == fastest_) return HUGE_VAL;
        low = high;
        high = std::min(fastest_, high * step);
      }
    } else {
      for (double step = 2.0; !is_above(low); step *= step) {
        if (low == slowest_) return 0.0;
        high = low;
        low = std::max(slowest_, low / step);
      }
    }
    while (high > (1.0 + kSharp) * low) {
      const double middle = std::sqrt(low * high);
      (is_above(middle) ? low : high) = middle;
    }
    return low;
  }

 private:
  struct Draw {
    ModelEstimate model;
    double sticks_m_per_s;  ///< the highest speed known to
    double slides_m_per_s;  ///< the lowest
  };

  std::size_t ending_below(double speed_m_per_s) {
    constexpr double kRough = 1e-3;  // of the static friction of the limit cycle, whose existence alone counts
    std::size_t count = 0;
    for (Draw& draw : draws_) {
      if (draw.sticks_m_per_s < speed_m_per_s && speed_m_per_s < draw.slides_m_per_s) {
        const bool sticks = aged_difference_N(draw.model, speed_m_per_s, kRough).has_value();
        (sticks ? draw.sticks_m_per_s : draw.slides_m_per_s) = speed_m_per_s;
      }
      if (draw.slides_m_per_s <= speed_m_per_s) ++count;
    }
    return count;
  }

  double slowest_;
  double fastest_;
  double near_;
  std::vector<Draw> draws_;
};

}  // namespace

std::optional<double> aged_difference_N(const ModelEstimate& model, double speed_m_per_s, double sharp) {
  const auto [rate_N, reference_s, cutoff_s] = *model.ageing;
  const model::AgeingLaw law{model.friction_difference_N, rate_N, reference_s, cutoff_s};
  return model::aged_difference_N(
      law,
      [&](double difference_N) -> std::optional<model::StickTime> {
        const MotionJets motion = held_motion_at(held_at(model, difference_N), speed_m_per_s);
        if (!motion.cycle) return std::nullopt;
        Jet stick_s = motion.cycle->stick_s;
        const double by_difference = take_derivative_by_difference(stick_s, difference_N);
        return model::StickTime{stick_s.a, by_difference};
      },
      sharp);
}

MotionJets ageing_motion_at(const ModelEstimate& model, double speed_m_per_s, double sharp) {
  const std::optional<double> difference_N = aged_difference_N(model, speed_m_per_s, sharp);
  // Next to the end of stick-slip, a static friction that is found roughly may have no cycle any more.
  MotionJets motion = held_motion_at(held_at(model, difference_N.value_or(0.0)), speed_m_per_s);
  if (!difference_N || !motion.cycle) {
    // Each slip is smaller than the one before, until nothing sticks: as for F_s = F_k.
    if (difference_N) motion = held_motion_at(held_at(model, 0.0), speed_m_per_s);
    motion.cycle.reset();
    motion.restick_margin.reset();
    if (motion.regime == Regime::StickSlip || motion.regime == Regime::StickSlipBistable) {
      motion.regime = Regime::OscillatorySlip;
    }
    return motion;
  }
  const Jet aged_N = aged_jet(model, *difference_N, motion.cycle->stick_s);
  CycleJets& cycle = *motion.cycle;
  std::vector<Jet*> all{&cycle.slip_s,       &cycle.stick_s,       &cycle.period_s, &cycle.periodic_displacement_m,
                        &cycle.force_peak_N, &cycle.force_trough_N};
  if (motion.restick_margin) all.push_back(&*motion.restick_margin);  // needed, not enough: the cycle ends sooner
  for (Jet* const y : all) {
    const double by_difference = take_derivative_by_difference(*y, *difference_N);
    y->v += by_difference * aged_N.v;
  }
  motion.aged_difference_N = aged_N;
  return motion;
}

double ageing_end_m_per_s(const ModelEstimate& model, double sharp) {
  double sticks = kSlowestEnd * speed_unit(model);
  double slides = kFastestEnd * speed_unit(model);
  if (!aged_difference_N(model, sticks)) return 0.0;
  if (aged_difference_N(model, slides)) return HUGE_VAL;
  while (slides > (1.0 + sharp) * sticks) {
    const double middle = std::sqrt(sticks * slides);
    (aged_difference_N(model, middle) ? sticks : slides) = middle;
  }
  return sticks;
}

CriticalPoint ageing_critical_point(const ModelEstimate& model, const Propagation& propagation) {
  constexpr double kSharp = 1e-14;
  // The speed goes as exp(-(F_s - F_k) / rate): its logarithm is nearly linear in the parameters.
  const ModelJets p(model);
  const double sticks = ageing_end_m_per_s(model, kSharp);
  if (sticks == 0.0) return CriticalPoint::unknown("no stick-slip at any speed");
  const auto of_draws = [&](const char* why) {
    EndsOfDraws ends(model, sticks);
    return by_draws(model, why, sticks, [&](double share) { return ends.quantile_m_per_s(share); });
  };
  if (std::isinf(sticks)) return of_draws("there is stick-slip at every speed looked at");
  const double difference_N = *aged_difference_N(model, sticks);
  const Jet speed = end_speed(model, difference_N, sticks);
  if (propagation.quantile() * propagation.standard_error(speed) > 2.0 * std::log(thresholds::kWidestFactor) * sticks) {
    return of_draws("ageing and damping are not known well enough to tell where stick-slip ends");
  }
  const Jet lambda = p.omega_rad_per_s * difference_N / (p.stiffness_N_per_m * speed);
  return {propagation.positive(lambda), propagation.positive(speed)};
}

}  // namespace slipfit::predict
