#include "model/weakening.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <tuple>

#include "model/root_between.hpp"

namespace slipfit::model {

SlipPart linear_part(const PartTimes& times, const PartJet& z, const PartJet& slope, const LinearForce& force,
                     const PartJet& zeta, bool is_transmitted) {
  std::array<PartJet, kSeriesOrder + 2> series{z, slope};  // a term more, for the drag
  for (std::size_t n = 0; n + 2 < series.size(); ++n) {
    const auto order = static_cast<double>(n);
    PartJet sum = force.by_z * series[n] - 2.0 * zeta * (order + 1.0) * series[n + 1];
    if (n == 0) sum += force.constant;
    if (n == 1) sum += force.by_time;
    series[n + 2] = sum / ((order + 1.0) * (order + 2.0));
  }
  SlipPart part{times.begin, times.length, {}};
  for (std::size_t n = 0; n <= kSeriesOrder; ++n) {
    PartJet term = series[n];
    if (is_transmitted) term += 2.0 * zeta * (static_cast<double>(n) + 1.0) * series[n + 1];
    part.terms[n] = {term.a, term.v[0], term.v[1], term.v[2], 0.0};
  }
  return part;
}

namespace {

/// When the speed comes back to 0 while the friction still falls: twice the mean of a swing, less where the swing
/// grows.
double time_to_stop(double g, double zeta) {
  if (!(zeta <= 0.0 && zeta * zeta + g < 0.0)) return std::numeric_limits<double>::infinity();
  const double turn = 2.0 * std::numbers::pi / std::sqrt(-zeta * zeta - g);
  constexpr double kBeyondAll = 100.0;  // a swing that grows to e^50 is longer than any D_c
  if (-zeta * turn > kBeyondAll) return std::numeric_limits<double>::infinity();
  return root_between([&](double tau) { return slide_at(g, zeta, tau).v; }, 0.5 * turn, turn);
}

}  // namespace

WeakeningSlip::WeakeningSlip(double z0, double zeta, double distance, ForceView view)
    : z0_(z0, 0),
      zeta_(zeta, 1),
      distance_(distance, 2),
      stiffening_((z0_ + 2.0 * zeta_) / distance_ - 1.0),
      view_(view) {
  const double tau = time_to_weaken();
  if (std::isfinite(tau)) {
    const Slide<double> slide = slide_at(stiffening_.a, zeta, tau);
    // x(tau; z0, zeta, distance) = distance
    const Slide<Jet> moved = slide_at(stiffening_, zeta_, Jet(tau));
    weakened_ = weakening_at(Jet(tau) - (moved.x - distance_) / slide.v);
    end_when_weakened();
  } else {
    end_while_weakening();
  }
  const Jet drag = view == ForceView::Transmitted ? 2.0 * zeta_ : Jet(0.0);
  before_ = z0_ + drag;
  after_ = end_.z - end_.tau + drag;
}

/// Infinite where the slip sticks before.
double WeakeningSlip::time_to_weaken() const {
  const double g = stiffening_.a;
  const double zeta = zeta_.a;
  const double longest = time_to_stop(g, zeta);
  double low = 0.0;
  double high = std::min(longest, std::cbrt(6.0 * distance_.a));  // x = tau^3 / 6 to begin with
  while (slide_at(g, zeta, high).x < distance_.a) {
    if (high >= longest) return std::numeric_limits<double>::infinity();
    low = high;
    high = std::min(longest, 2.0 * high);
  }
  // The logarithm of x is straight where x grows fast.
  const auto excess = [&](double tau) {
    const Slide<double> slide = slide_at(g, zeta, tau);
    const double growth = slide.v / slide.x;
    return std::tuple(std::log(slide.x / distance_.a), growth, slide.a / slide.x - growth * growth);
  };
  return root_near(excess, high, low, high);
}

WeakeningSlip::State WeakeningSlip::weakening_at(const Jet& tau) const {
  const Slide<Jet> slide = slide_at(stiffening_, zeta_, tau);
  return {tau, z0_ + tau - slide.x, 1.0 - slide.v, -slide.a, tau * (z0_ + 0.5 * tau) - slide.integral};
}

/// z'' + 2 zeta z' + z = 0 from where the friction has become F_k; its integral is that of (1).
WeakeningSlip::State WeakeningSlip::weakened_at(const Jet& tau) const {
  const Jet since = tau - weakened_.tau;
  const Jet b = sqrt(1.0 - zeta_ * zeta_);
  const Jet c = exp(-zeta_ * since) * cos(b * since);
  const Jet s = exp(-zeta_ * since) * sin(b * since) / b;
  const Jet z = weakened_.z * c + (weakened_.dz + zeta_ * weakened_.z) * s;
  const Jet dz = weakened_.dz * c - (weakened_.z + zeta_ * weakened_.dz) * s;
  const Jet integral = weakened_.integral + weakened_.dz - dz + 2.0 * zeta_ * (weakened_.z - z);
  return {tau, z, dz, -2.0 * zeta_ * dz - z, integral};
}

/// z' meets 1 between the largest sliding speed, or the end of weakening where that comes later, and the smallest one:
/// there z'' = 0.
void WeakeningSlip::end_when_weakened() {
  const double zeta = zeta_.a;
  const double b = std::sqrt(1.0 - zeta * zeta);
  const SlipPoint<double> begin{weakened_.z.a, weakened_.dz.a, -2.0 * zeta * weakened_.dz.a - weakened_.z.a};
  // z'' = exp(-zeta tau) (p cos b tau + q sin b tau) is a sine of phase atan2(p, q).
  const double phase = std::atan2(begin.ddz, (-zeta * begin.ddz - begin.dz) / b);
  const double fastest = std::max(0.0, -phase / b);
  const double slowest = (std::numbers::pi - phase) / b;
  const auto stick = [&](double since) {
    const double decay = std::exp(-zeta * since);
    const double c = decay * std::cos(b * since);
    const double s = decay * std::sin(b * since) / b;
    const double dz = begin.dz * c - (begin.z + zeta * begin.dz) * s;
    const double ddz = begin.ddz * c - (begin.dz + zeta * begin.ddz) * s;
    return std::tuple(dz - 1.0, ddz, -2.0 * zeta * ddz - dz);
  };
  resticks_ = std::get<0>(stick(slowest)) >= 0.0;
  // Without damping z' is a sine from the end of weakening on.
  const double swing = std::hypot(begin.dz, begin.z);
  const double undamped =
      2.0 * std::numbers::pi - std::acos(std::min(1.0, 1.0 / swing)) - std::atan2(begin.z, begin.dz);
  const double since = resticks_ ? root_near(stick, std::clamp(undamped, fastest, slowest), fastest, slowest) : slowest;
  tau_end_ = weakened_.tau.a + since;
  end_ = weakened_at(Jet(tau_end_));
  if (resticks_) return;
  const Jet dddz = -2.0 * zeta_ * end_.ddz - end_.dz;
  end_ = weakened_at(Jet(tau_end_) - end_.ddz / dddz);
}

/// This happens only where zeta <= 0: otherwise the speed does not come back to 0.
void WeakeningSlip::end_while_weakening() {
  tau_end_ = time_to_stop(stiffening_.a, zeta_.a);
  weakened_.tau = Jet(std::numeric_limits<double>::infinity());
  weakened_.dz = Jet(1.0);
  end_ = weakening_at(Jet(tau_end_));
}

WeakeningSlip::State WeakeningSlip::state_at(double tau) const {
  const Jet now(tau);
  if (tau <= 0.0) return {now, z0_ + tau, Jet(1.0), Jet(0.0), tau * (z0_ + 0.5 * tau)};
  if (tau <= tau_end_) return tau <= weakened_.tau.a ? weakening_at(now) : weakened_at(now);
  // A slip that sticks again joins its ramp with equal slope: the moving end adds nothing to first order.
  const Jet since = tau - end_.tau;
  return {now, end_.z + since, Jet(1.0), Jet(0.0), end_.integral + since * (end_.z + 0.5 * since)};
}

/// Returns the state in the view: z, its derivative and its integral.
WeakeningSlip::State WeakeningSlip::shown_at(double tau) const {
  State state = state_at(tau);
  if (view_ != ForceView::Transmitted) return state;
  state.integral += 2.0 * zeta_ * state.z;
  state.z += 2.0 * zeta_ * state.dz;
  state.dz += 2.0 * zeta_ * state.ddz;
  return state;
}

WeakeningPoint WeakeningSlip::at(double tau) const {
  if (tau <= 0.0 || tau > tau_end_) {  // straight, and by far the most of a cycle
    const Jet& stick = tau <= 0.0 ? before_ : after_;
    return {{stick.a + tau, stick.v[0], stick.v[1], 1.0}, stick.v[2]};
  }
  const State now = shown_at(tau);
  return {{now.z.a, now.z.v[0], now.z.v[1], now.dz.a}, now.z.v[2]};
}

WeakeningPoint WeakeningSlip::integral_to(double tau) const {
  const State now = shown_at(tau);
  return {{now.integral.a, now.integral.v[0], now.integral.v[1], now.z.a}, now.integral.v[2]};
}

/// While the friction falls, x'' + 2 zeta x' - g x = tau with z = z0 + tau - x gives
/// z'' = g z - 2 zeta z' + 2 zeta - g z0 - (1 + g) tau.
SlipPart WeakeningSlip::part_from(const State& begin, double length, bool weakens) const {
  LinearForce force;
  if (weakens) {
    force.by_z = stiffening_;
    force.by_time = -(1.0 + stiffening_);
    force.constant = 2.0 * zeta_ - stiffening_ * z0_ + force.by_time * begin.tau.a;
  }
  return linear_part({begin.tau.a, length}, begin.z, begin.dz, force, zeta_, view_ == ForceView::Transmitted);
}

std::vector<SlipPart> WeakeningSlip::parts() const {
  const double weakened = std::min(weakened_.tau.a, tau_end_);
  const double rate = std::abs(zeta_.a) + std::sqrt(std::abs(zeta_.a * zeta_.a + stiffening_.a));
  std::vector<SlipPart> parts;
  const auto add = [&](double from, double to, double fastest, bool weakens) {
    constexpr double kMost = 1e3;  // a search far from any slip may try one that hardly ends
    const double count = std::ceil(std::max(1.0, fastest) * (to - from));  // in steps of a radian: kSeriesOrder
    if (!(count < kMost)) return;
    for (double i = 0.0; i < count; ++i) {
      const Jet begin(from + i / count * (to - from));
      parts.push_back(part_from(weakens ? weakening_at(begin) : weakened_at(begin), (to - from) / count, weakens));
    }
  };
  add(0.0, weakened, rate, true);
  add(weakened, tau_end_, 1.0, false);
  return parts;
}

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
