#include "fit/inference/sliding_model.hpp"

#include <cmath>
#include <utility>

#include "fit/law/speed_dependent.hpp"
#include "model/ageing.hpp"
#include "model/relaxing.hpp"
#include "model/reloading.hpp"
#include "model/slip_jets.hpp"

namespace slipfit::fit {

SlidingModel::SlidingModel(const Coordinates& values, const Units& units) {
  const auto jet = [&](int i) { return Jet(values(i), i); };
  stiffness = exp(jet(kLogStiffness));
  omega = exp(jet(kLogFrequency));
  zeta = jet(kDamping);
  const SlopeRatio ratio = slope_ratio(FrictionLaw::Exponential, values(kFrictionRate));
  Jet ratio_jet(ratio.value);
  ratio_jet.v(kFrictionRate) = ratio.derivative;
  slope = 2.0 * jet(kFrictionSlope) * ratio_jet * stiffness / omega;
  alpha = jet(kFrictionRate) / units.slip_speed_m_per_s;
  level = units.level + units.force * jet(kLevel);
  difference = units.force * jet(kDifference);
  ageing = units.force * jet(kAgeing);
  ageing_time = units.stick_s * jet(kAgeingTime);
  slip_distance = units.slip_distance_m * jet(kSlipDistance) * jet(kSlipDistance);
  if (values(kReloadForce) > 0.0) reload = Reload{units.force * jet(kReloadForce), exp(jet(kReloadLength))};
  if (values(kRelaxation) > 0.0) relaxation = Relaxation{jet(kRelaxation), exp(jet(kRelaxationTime))};
  stiffness_exponent = jet(kStiffnessExponent);
  reference_stick_s_ = units.stick_s;
  reference_speed_m_per_s_ = units.speed_m_per_s;
}

Jet SlidingModel::growth_at(double speed_m_per_s) const {
  return exp(stiffness_exponent * std::log(speed_m_per_s / reference_speed_m_per_s_));
}

Jet SlidingModel::excess_friction(double speed_m_per_s) const {
  const Jet rate = alpha * speed_m_per_s;
  if (std::abs(rate.a) < 1e-6) return slope * speed_m_per_s * (1.0 + 0.5 * rate);
  return slope * (exp(rate) - 1.0) / alpha;
}

std::optional<Jet> SlidingModel::spacing(double speed_m_per_s, double load) const {
  const std::optional<Jet> aged_N = aged_difference_N(speed_m_per_s, load);
  if (!aged_N) return std::nullopt;
  const std::optional<Cycle> limit = cycle(speed_m_per_s, load, *aged_N);
  if (!limit) return std::nullopt;
  return speed_m_per_s * limit->period_s;
}

std::optional<SlidingModel::Cycle> SlidingModel::cycle(double speed_m_per_s, double load,
                                                       const Jet& difference_N) const {
  const Jet growth = growth_at(speed_m_per_s);
  const Jet k = stiffness * growth;
  const Jet w = omega * sqrt(growth);  // of the same mass
  if (relaxation) {
    const model::RelaxingBody<Jet> body{k, w, zeta, load * difference_N, relaxation->share, relaxation->time_s};
    const auto limit = body.cycle_at(speed_m_per_s);
    return limit ? std::optional(Cycle{limit->period_s, limit->period_s - limit->slip_s}) : std::nullopt;
  }
  const model::SlipJets<Jet> slip(k, w, zeta, load * difference_N, load * slope, alpha, speed_m_per_s);
  const auto track = slip.solve();
  if (!track || !track->resticks()) return std::nullopt;
  const Jet tau_period = slip.tau_period(*track);
  const Jet tau_slip = slip.tau_slip(track->end());
  const Jet straight_s = (tau_period - tau_slip) / w;
  if (!reload) return Cycle{tau_period / w, straight_s};
  const Jet stick_m = model::reloaded_stick_m(speed_m_per_s * straight_s, load * reload->force_N / k, reload->length_m);
  return Cycle{tau_slip / w + stick_m / speed_m_per_s, stick_m / speed_m_per_s};
}

std::optional<Jet> SlidingModel::aged_difference_N(double speed_m_per_s, double load) const {
  if (ageing.a == 0.0) return difference;
  const auto stick_of = [&](double difference_N) -> std::optional<Jet> {
    Jet held_N(difference_N, kDifference);
    const std::optional<Cycle> limit = cycle(speed_m_per_s, load, held_N);
    return limit ? std::optional(limit->stick_s) : std::nullopt;
  };
  const model::AgeingLaw law{difference.a, ageing.a, reference_stick_s_, ageing_time.a};
  const std::optional<double> solution_N =
      model::aged_difference_N(law, [&](double difference_N) -> std::optional<model::StickTime> {
        const std::optional<Jet> stick_s = stick_of(difference_N);
        if (!stick_s) return std::nullopt;
        return model::StickTime{stick_s->a, stick_s->v(kDifference)};
      });
  if (!solution_N) return std::nullopt;
  Jet stick_s = *stick_of(*solution_N);
  const double by_difference = std::exchange(stick_s.v(kDifference), 0.0);
  return model::aged_difference_N(*solution_N,
                                  model::AgeingLawOf<Jet>{difference, ageing, reference_stick_s_, ageing_time}, stick_s,
                                  by_difference);
}

}  // namespace slipfit::fit
