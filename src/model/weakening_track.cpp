#include "model/weakening_track.hpp"

#include <cmath>

namespace slipfit::model {

WeakeningTrack::Walker::Walker(const WeakeningSlip& slip, double step_tau, bool sums)
    : slip_(slip),
      step_tau_(step_tau),
      sums_(sums),
      g_(slip.stiffening_.a, 0),
      zeta_(slip.zeta_.a, 1),
      step_(slide_at(g_, zeta_, Slope(step_tau))),
      // From rest, forces that grow as tau, that are 1 and that are a blow move x by x, x' and x'' of `step_`.
      x_by_x_(1.0 + g_ * step_.v),
      v_by_x_(g_ * step_.a),
      v_by_v_(x_by_x_ - 2.0 * zeta_ * step_.a),
      integral_by_x_(step_tau + g_ * step_.x),
      b_(std::sqrt(1.0 - slip.zeta_.a * slip.zeta_.a)),
      phasor_(slip.zeta_.a, b_, step_tau),
      z_sine_(slip.weakened_.dz + slip.zeta_ * slip.weakened_.z),
      slope_sine_(slip.weakened_.z + slip.zeta_ * slip.weakened_.dz),
      after_(slip.end_.z - slip.end_.tau),
      integral_after_(slip.end_.integral - slip.end_.tau * (after_ + 0.5 * slip.end_.tau)) {}

// Inline: asked for every sample.

inline WeakeningTrack::Jet WeakeningTrack::Walker::chained(const Slope& value) const {
  Jet jet(value.a);
  jet.v = value.v[0] * slip_.stiffening_.v;
  jet.v[1] += value.v[1];
  return jet;
}

inline void WeakeningTrack::Walker::move_to(double tau) {
  Part part = Part::Weakened;
  if (tau <= 0.0) {
    part = Part::Before;
  } else if (tau > slip_.tau_end_) {
    part = Part::After;
  } else if (tau <= slip_.weakened_.tau.a) {
    part = Part::Weakening;
  }
  const bool is_next = part == part_ && tau < tau_ + 1.5 * step_tau_;
  if (part == Part::Weakening) weaken(tau, is_next);
  if (part == Part::Weakened) swing(tau, is_next);
  tau_ = tau;
  part_ = part;
}

inline void WeakeningTrack::Walker::weaken(double tau, bool is_next) {
  if (!is_next) {
    const Slide<Slope> slide = slide_at(g_, zeta_, Slope(tau));
    x_ = slide.x;
    v_ = slide.v;
    integral_ = slide.integral;
    return;
  }
  if (sums_) integral_ += integral_by_x_ * x_ + step_.v * v_ + step_.x * tau_ + step_.integral;
  const Slope x = x_by_x_ * x_ + step_.a * v_ + step_.v * tau_ + step_.x;
  v_ = v_by_x_ * x_ + v_by_v_ * v_ + step_.a * tau_ + step_.v;
  x_ = x;
}

inline void WeakeningTrack::Walker::swing(double tau, bool is_next) {
  const Jet& begin = slip_.weakened_.tau;
  const double since = tau - begin.a;
  is_next ? phasor_.step() : phasor_.start(since);
  const double zeta = zeta_.a;
  c_.a = phasor_.c();
  s_.a = phasor_.s() / b_;
  c_.v = (zeta * c_.a + b_ * b_ * s_.a) * begin.v;
  s_.v = (zeta * s_.a - c_.a) * begin.v;
  c_.v[1] += since * (zeta * s_.a - c_.a);
  s_.v[1] += zeta / (b_ * b_) * (s_.a - since * c_.a) - since * s_.a;
}

inline double WeakeningTrack::Walker::force() const {
  if (part_ == Part::Before) return slip_.z0_.a + tau_;
  if (part_ == Part::After) return after_.a + tau_;
  if (part_ == Part::Weakening) return slip_.z0_.a + tau_ - x_.a;
  return slip_.weakened_.z.a * c_.a + z_sine_.a * s_.a;
}

inline double WeakeningTrack::Walker::slope() const {
  if (part_ == Part::Before || part_ == Part::After) return 1.0;
  return part_ == Part::Weakening ? 1.0 - v_.a : slip_.weakened_.dz.a * c_.a - slope_sine_.a * s_.a;
}

inline WeakeningTrack::Jet WeakeningTrack::Walker::z() const {
  if (part_ == Part::Before) return slip_.z0_ + tau_;
  if (part_ == Part::After) return after_ + tau_;
  if (part_ == Part::Weakening) return slip_.z0_ + tau_ - chained(x_);
  return slip_.weakened_.z * c_ + z_sine_ * s_;
}

inline WeakeningTrack::Jet WeakeningTrack::Walker::dz() const {
  if (part_ == Part::Before || part_ == Part::After) return Jet(1.0);
  if (part_ == Part::Weakening) return 1.0 - chained(v_);
  return slip_.weakened_.dz * c_ - slope_sine_ * s_;
}

inline double WeakeningTrack::Walker::ddz() const {
  if (part_ == Part::Before || part_ == Part::After) return 0.0;
  if (part_ == Part::Weakening) return 2.0 * zeta_.a * v_.a - tau_ - g_.a * x_.a;
  return -2.0 * zeta_.a * slope() - force();
}

/// After the friction has fallen, the integral of z follows from z'' + 2 zeta z' + z = 0, of which z is one term.
inline WeakeningTrack::Jet WeakeningTrack::Walker::integral() const {
  if (part_ == Part::Before) return tau_ * (slip_.z0_ + 0.5 * tau_);
  if (part_ == Part::After) return integral_after_ + tau_ * (after_ + 0.5 * tau_);
  if (part_ == Part::Weakening) return tau_ * (slip_.z0_ + 0.5 * tau_) - chained(integral_);
  const WeakeningSlip::State& from = slip_.weakened_;
  return from.integral + from.dz - dz() + 2.0 * slip_.zeta_ * (from.z - z());
}

WeakeningPoint WeakeningTrack::at(double tau) {
  const double reach = 0.5 * average_;
  if (tau + reach <= 0.0 || tau - reach > slip_.tau_end_) return slip_.at(tau);  // the middle of a straight line
  last_.move_to(tau + reach);
  if (average_ == 0.0) return instant();
  first_.move_to(tau - reach);
  return mean();
}

WeakeningPoint WeakeningTrack::instant() const {
  Jet shown = last_.z();
  double slope = last_.slope();
  if (is_transmitted()) {
    shown += 2.0 * slip_.zeta_ * last_.dz();
    slope += 2.0 * slip_.zeta_.a * last_.ddz();
  }
  return {{shown.a, shown.v[0], shown.v[1], slope}, shown.v[2]};
}

WeakeningPoint WeakeningTrack::mean() const {
  Jet sum = last_.integral() - first_.integral();
  double first = first_.force();
  double last = last_.force();
  if (is_transmitted()) {
    sum += 2.0 * slip_.zeta_ * (last_.z() - first_.z());
    first += 2.0 * slip_.zeta_.a * first_.slope();
    last += 2.0 * slip_.zeta_.a * last_.slope();
  }
  const Jet mean = sum / average_;
  const double by_log_average = 0.5 * (first + last) - mean.a;
  return {{mean.a, mean.v[0], mean.v[1], (last - first) / average_, by_log_average, by_log_average}, mean.v[2]};
}

}  // namespace slipfit::model
