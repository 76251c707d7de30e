#include "model/weakening_track.hpp"

#include <cmath>

#include "model/weakening_slide.hpp"

namespace slipfit::model {

WeakeningTrack::WeakeningTrack(const WeakeningSlip& slip, double step_tau)
    : slip_(slip),
      g_(slip.stiffening_.a, 0),
      zeta_(slip.zeta_.a, 1),
      step_tau_(step_tau),
      b_(std::sqrt(1.0 - slip.zeta_.a * slip.zeta_.a)),
      phasor_(slip.zeta_.a, b_, step_tau),
      z_sine_(slip.weakened_.dz + slip.zeta_ * slip.weakened_.z),
      slope_sine_(slip.weakened_.z + slip.zeta_ * slip.weakened_.dz) {
  // From rest, forces that grow as tau, that are 1 and that are a blow move x by x, x' and x'' of this:
  const Slide<Slope> step = slide_at(g_, zeta_, Slope(step_tau));
  x_by_one_ = step.x;
  x_by_tau_ = step.v;
  x_by_v_ = step.a;
  x_by_x_ = 1.0 + g_ * step.v;
  v_by_x_ = g_ * step.a;
  v_by_v_ = x_by_x_ - 2.0 * zeta_ * step.a;
}

WeakeningPoint WeakeningTrack::at(double tau) {
  if (tau <= 0.0 || tau > slip_.tau_end_) return slip_.at(tau);
  return tau <= slip_.weakened_.tau.a ? weakening_at(tau) : weakened_at(tau);
}

WeakeningPoint WeakeningTrack::weakening_at(double tau) {
  if (is_next(tau)) {
    const Slope x = x_by_x_ * x_ + x_by_v_ * v_ + x_by_tau_ * last_tau_ + x_by_one_;
    v_ = v_by_x_ * x_ + v_by_v_ * v_ + x_by_v_ * last_tau_ + x_by_tau_;
    x_ = x;
  } else {
    const Slide<Slope> slide = slide_at(g_, zeta_, Slope(tau));
    x_ = slide.x;
    v_ = slide.v;
  }
  last_tau_ = tau;
  const double acceleration = tau + g_.a * x_.a - 2.0 * zeta_.a * v_.a;
  return shown(slip_.z0_ + tau - chained(x_), 1.0 - chained(v_), -acceleration);
}

WeakeningPoint WeakeningTrack::weakened_at(double tau) {
  const WeakeningSlip::State& from = slip_.weakened_;
  const double since = tau - from.tau.a;
  is_weakened_&& is_next(tau) ? phasor_.step() : phasor_.start(since);
  is_weakened_ = true;
  last_tau_ = tau;
  const double zeta = zeta_.a;
  Jet c(phasor_.c());
  Jet s(phasor_.s() / b_);
  c.v = (zeta * c.a + b_ * b_ * s.a) * from.tau.v;
  s.v = (zeta * s.a - c.a) * from.tau.v;
  c.v[1] += since * (zeta * s.a - c.a);
  s.v[1] += zeta / (b_ * b_) * (s.a - since * c.a) - since * s.a;
  const Jet z = from.z * c + z_sine_ * s;
  const Jet dz = from.dz * c - slope_sine_ * s;
  return shown(z, dz, -2.0 * zeta * dz.a - z.a);
}

WeakeningTrack::Jet WeakeningTrack::chained(const Slope& value) const {
  Jet jet(value.a);
  jet.v = value.v[0] * slip_.stiffening_.v;
  jet.v[1] += value.v[1];
  return jet;
}

WeakeningPoint WeakeningTrack::shown(const Jet& z, const Jet& dz, double ddz) const {
  if (slip_.view_ != ForceView::Transmitted) return {{z.a, z.v[0], z.v[1], dz.a}, z.v[2]};
  const Jet both = z + 2.0 * slip_.zeta_ * dz;
  return {{both.a, both.v[0], both.v[1], dz.a + 2.0 * zeta_.a * ddz}, both.v[2]};
}

}  // namespace slipfit::model
