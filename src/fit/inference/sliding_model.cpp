#include "fit/inference/sliding_model.hpp"

#include <cmath>

#include "fit/law/speed_dependent.hpp"

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

Jet SlidingModel::excess_friction(double speed_m_per_s) const {
  const Jet rate = alpha * speed_m_per_s;
  if (std::abs(rate.a) < 1e-6) return slope * speed_m_per_s * (1.0 + 0.5 * rate);
  return slope * (exp(rate) - 1.0) / alpha;
}

model::SlidingBody<Jet> SlidingModel::body_at(double speed_m_per_s, double load) const {
  const Jet growth = exp(stiffness_exponent * std::log(speed_m_per_s / reference_speed_m_per_s_));
  model::SlidingBody<Jet> body{speed_m_per_s, stiffness * growth, omega * sqrt(growth),  // of the same mass
                               zeta,          load * difference,  load * slope,         alpha};
  if (ageing.a != 0.0) body.ageing = {load * ageing, ageing_time, reference_stick_s_};
  if (reload) body.rise = {load * reload->force_N, reload->length_m};
  body.relaxation = relaxation;
  return body;
}

std::optional<Jet> SlidingModel::spacing(double speed_m_per_s, double load) const {
  model::SlidingBody<Jet> body = body_at(speed_m_per_s, load);
  const std::optional<Jet> aged_N = body.aged_difference_N();
  if (!aged_N) return std::nullopt;
  body.difference_N = *aged_N;
  const auto limit = body.cycle();
  return limit ? std::optional(speed_m_per_s * limit->period_s()) : std::nullopt;
}

std::optional<model::SlidingCycle<Jet>> SlidingModel::cycle(double speed_m_per_s, double load,
                                                            const Jet& difference_N) const {
  model::SlidingBody<Jet> body = body_at(speed_m_per_s, load);
  body.difference_N = load * difference_N;
  return body.cycle();
}

}  // namespace slipfit::fit
