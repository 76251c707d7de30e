#include "fit/observation/averaged_slip.hpp"

namespace slipfit::fit {

// Inline: asked for every sample.

inline AveragedSlip::Force AveragedSlip::shown(const model::WavePoint& spring, Integral integral) const {
  integral.value += drag_ * spring.z;
  integral.d_z0 += drag_ * spring.d_z0;
  integral.d_zeta += drag_ * spring.d_zeta + drag_by_zeta_ * spring.z;
  return {spring.z + drag_ * spring.d_tau, integral};
}

/// z'' + 2 zeta z' + z = 0 gives the integral of z over the slip: 1 + 2 zeta (z0 - z) - z'.
inline AveragedSlip::Force AveragedSlip::sliding_at(double tau, double c, double bs) const {
  const double s = bs * by_b_;
  const double zeta = slip_.zeta;
  const model::WavePoint spring = model::slip_wave(slip_, tau, c, s);
  const double ds_dzeta = -tau * s + zeta * by_b_ * by_b_ * (s - tau * c);
  const double slope_d_zeta = tau * (zeta * s - c) - s - (slip_.z0 + zeta) * ds_dzeta;
  return shown(spring, {1.0 + 2.0 * zeta * (slip_.z0 - spring.z) - spring.d_tau, 2.0 * zeta * (1.0 - spring.d_z0) + s,
                        2.0 * (slip_.z0 - spring.z) - 2.0 * zeta * spring.d_zeta - slope_d_zeta});
}

inline AveragedSlip::Force AveragedSlip::sticking_at(double tau) const {
  const model::StickLine line = tau <= 0.0 ? model::StickLine{slip_.z0, 1.0, 0.0} : after_;
  Integral integral = tau <= 0.0 ? Integral{} : until_after_;
  integral.value += tau * (line.intercept + 0.5 * tau);
  integral.d_z0 += tau * line.d_z0;
  integral.d_zeta += tau * line.d_zeta;
  return shown({line.intercept + tau, line.d_z0, line.d_zeta, 1.0}, integral);
}

inline model::WavePoint AveragedSlip::between(const Force& first, const Force& last) const {
  const double scale = 0.5 / half_;
  const double mean = scale * (last.integral.value - first.integral.value);
  return {mean, scale * (last.integral.d_z0 - first.integral.d_z0),
          scale * (last.integral.d_zeta - first.integral.d_zeta), scale * (last.z - first.z),
          0.5 * (first.z + last.z) - mean};
}

AveragedSlip::AveragedSlip(const model::Slip& slip, const model::StickLine& after, double average_tau, bool transmitted)
    : slip_(slip), after_(after), half_(0.5 * average_tau), by_b_(1.0 / slip.b) {
  // In the spring's view, from where both hold.
  const double tau = slip.tau_end;
  until_after_ = force_at(tau).integral;
  until_after_.value -= tau * (after.intercept + 0.5 * tau);
  until_after_.d_z0 -= tau * after.d_z0;
  until_after_.d_zeta -= tau * after.d_zeta;
  if (!transmitted) return;
  drag_ = 2.0 * slip.zeta;
  drag_by_zeta_ = 2.0;
}

AveragedSlip::Force AveragedSlip::force_at(double tau) const {
  if (!slides_at(tau)) return sticking_at(tau);
  const double decay = std::exp(-slip_.zeta * tau);
  return sliding_at(tau, decay * std::cos(slip_.b * tau), decay * std::sin(slip_.b * tau));
}

model::WavePoint AveragedSlip::at(double tau) const {
  return between(force_at(tau - half_), force_at(tau + half_));
}

model::WavePoint AveragedSlip::Samples::at(double tau) {
  const double first = tau - slip_.half_;
  const double last = tau + slip_.half_;
  if (tau < next_tau_ + 0.5 * step_tau_) {
    first_.step();
    last_.step();
  } else {
    first_.start(first);
    last_.start(last);
  }
  next_tau_ = tau + step_tau_;
  const auto force_at = [this](double at, const model::Phasor& phasor) {
    return slip_.slides_at(at) ? slip_.sliding_at(at, phasor.c(), phasor.s()) : slip_.sticking_at(at);
  };
  return slip_.between(force_at(first, first_), force_at(last, last_));
}

}  // namespace slipfit::fit
