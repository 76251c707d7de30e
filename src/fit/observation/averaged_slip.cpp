#include "fit/observation/averaged_slip.hpp"

#include <cmath>

namespace slipfit::fit {

AveragedSlip::AveragedSlip(const model::Slip& slip, const model::StickLine& after, double average_tau, bool transmitted)
    : zeta_(slip.zeta),
      b_(slip.b),
      tau_end_(slip.tau_end),
      half_(0.5 * average_tau),
      by_average_(1.0 / average_tau),
      slide_(slide_of(slip)) {
  before_ = {{slip.z0}, 1.0, 0.0};
  const double tau = tau_end_;
  const Force end = force_at(tau);
  after_ = {{after.intercept, end.integral - tau * (after.intercept + 0.5 * tau), end.d_z0 - tau * after.d_z0,
             end.d_zeta - tau * after.d_zeta},
            after.d_z0,
            after.d_zeta};
  if (transmitted) transmit(slip, after);
}

/// Returns the slide of the spring's force. z'' + 2 zeta z' + z = 0 gives the integral of z: 1 + 2 zeta (z0 - z) - z'.
AveragedSlip::Slide AveragedSlip::slide_of(const model::Slip& slip) {
  const double z0 = slip.z0;
  const double zeta = slip.zeta;
  const double by_b = 1.0 / slip.b;
  const double bend = (z0 + zeta) * by_b * by_b;  // as in model::slip_wave
  const double start = 1.0 + 2.0 * zeta * z0;
  return {{0.0, start, 2.0 * zeta, 2.0 * z0},
          {z0, -start, -2.0 * zeta, -2.0 * z0},
          {by_b * (1.0 + zeta * z0), by_b * (z0 - zeta * start), by_b * (1.0 - 2.0 * zeta * zeta),
           -by_b * (start + zeta * bend)},
          1.0 + zeta * bend,
          -by_b * z0};
}

/// 2 zeta z' on top, the integral of which is 2 zeta z.
void AveragedSlip::transmit(const model::Slip& slip, const model::StickLine& after) {
  const double z0 = slip.z0;
  const double zeta = slip.zeta;
  const double drag = 2.0 * zeta;
  const double by_b = 1.0 / slip.b;
  const double bend = (z0 + zeta) * by_b * by_b;
  const auto add = [](Force& force, const Force& more) {
    force.z += more.z;
    force.integral += more.integral;
    force.d_z0 += more.d_z0;
    force.d_zeta += more.d_zeta;
  };
  add(slide_.by_c, {drag, drag * z0, drag, 2.0 * z0});
  add(slide_.by_s, {-drag * by_b * (z0 + zeta), drag * by_b * (1.0 + zeta * z0), drag * by_b * zeta,
                    by_b * (drag * bend + 2.0 * (1.0 + zeta * z0))});
  slide_.d_zeta_by_tau_c -= drag * bend;
  slide_.d_zeta_by_tau_s -= drag * by_b;
  add(before_.constant, {drag, drag * z0, drag, 2.0 * z0});
  add(after_.constant, {drag, drag * after.intercept, drag * after.d_z0, drag * after.d_zeta + 2.0 * after.intercept});
  before_.d_zeta_by_tau += 2.0;
  after_.d_zeta_by_tau += 2.0;
}

AveragedSlip::Force AveragedSlip::force_at(double tau) const {
  if (!slides_at(tau)) return sticking_at(tau);
  const double decay = std::exp(-zeta_ * tau);
  return sliding_at(tau, decay * std::cos(b_ * tau), decay * std::sin(b_ * tau));
}

model::WavePoint AveragedSlip::at(double tau) const {
  return between(force_at(tau - half_), force_at(tau + half_));
}

}  // namespace slipfit::fit
