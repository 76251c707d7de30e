#pragma once

// One slip with velocity-dependent friction, scaled (velocity_law.hpp), followed by steps of its Taylor series: with or
// without its derivatives, to the instant at which it comes to rest.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "model/slip_series.hpp"
#include "model/velocity_law.hpp"

namespace slipfit::model {

/// States how exactly a slip is followed.
struct SlipAccuracy {
  double tolerance;  ///< of the last terms of a step, over the size of each component
  int most_steps;    ///< an ordinary slip needs 4 to 20; one that needs more than these has no solution
};
/// This gives the end of slip to 1e-10 and derivatives to 1e-9.
inline constexpr SlipAccuracy kExact{1e-13, 20000};
/// Fits need 1e-7 only, and solve some hundred thousand slips: five times what an ordinary one needs bounds their time.
inline constexpr SlipAccuracy kForFits{1e-7, 100};

/// The speed turns at most once in a step: a third of the half turn in which it does.
inline constexpr double kLongestStep = 1.0;

/// The last terms of a series do not show an exponential that is negligible at the start of a step and grows by more
/// than its order in it: near rest with rate < 0, at high speed with rate > 0.
inline double longest_slip_step(const ScaledLaw& law, double v, double acceleration) {
  constexpr double kNegligible = 40.0;  // exp(-40) is below round-off
  constexpr double kMostGrowth = 10.0;  // terms of order 13 and 14 are among the largest of exp(10)
  constexpr double kFreeShare = 0.5;    // of the way to where it counts: the acceleration may grow
  const double towards_friction = law.rate * acceleration;
  if (!(towards_friction > 0.0) || law.slope == 0.0) return kLongestStep;
  const double exponent = law.rate * v;
  const double free = law.rate < 0.0 ? std::max(0.0, -exponent - kNegligible) : 0.0;
  return std::min(kLongestStep, (kFreeShare * free + kMostGrowth) / towards_friction);
}

/// One instant of a slip.
struct SlipNode {
  double tau = 0.0;
  SlipState state;
  double acceleration = 0.0;
  double integral = 0.0;  ///< of s from the onset on
};

/// Walks a slip from stick. `from` and `to` are the ends of the last step, between which `series` holds.
template <bool kWithGradient>
class SlipWalker {
 public:
  SlipWalker(const ScaledSlip& slip, const SlipAccuracy& accuracy) : slip_(slip), accuracy_(accuracy) {
    to.state.s = slip.lambda;
    if (kWithGradient) to.state.ds = {1.0, 2.0, 0.0, 0.0};  // s(0) = z0 + 2 zeta
    to.acceleration = slip.lambda;
    const double size = 1.0 + slip.lambda;
    // Sizes of the derivatives; those of the law fade where the friction has changed before the slip is under way.
    const double reach = size / (1.0 + std::abs(slip.law.rate) * size);
    const double tiny = 1e-200;       // a law without slope has no derivative with respect to its rate: 0 / 0
    constexpr double kRougher = 5.0;  // than the motion itself
    sizes_ = {1.0, size, reach, std::abs(slip.law.slope) * reach * reach + tiny};
    for (double& derivative : sizes_) derivative *= kRougher;
  }

  SlipNode from, to;
  SlipSeries<kWithGradient> series;

  /// False where no step length serves: the solution runs away.
  bool advance() {
    from = to;
    series = SlipSeries<kWithGradient>(slip_, from.state);
    double length = longest_slip_step(slip_.law, from.state.v, from.acceleration);
    for (std::size_t n = kSeriesOrder - 1; n <= kSeriesOrder; ++n) {
      const double last = size_of_term(n);
      if (!std::isfinite(last)) return false;
      if (last > 0.0) length = std::min(length, std::pow(accuracy_.tolerance / last, 1.0 / static_cast<double>(n)));
    }
    to = inside(length);
    return to.tau > from.tau && std::isfinite(to.acceleration);
  }

  [[nodiscard]] double length() const { return to.tau - from.tau; }

  /// Returns the node that is `time` after the start of the last step.
  [[nodiscard]] SlipNode inside(double time) const {
    return {from.tau + time, series.at(time), series.acceleration_at(time),
            from.integral + integral_of(series.s, time)};
  }

 private:
  /// Returns the size of the term of power n in the last step, over the sizes of the components.
  [[nodiscard]] double size_of_term(std::size_t n) const {
    double worst = std::max(std::abs(series.s[n]), std::abs(series.v[n])) / (1.0 + slip_.lambda);
    if constexpr (kWithGradient) {
      for (std::size_t p = 0; p < kScaledParameters; ++p) {
        // What has grown by an exponential is followed by its own size.
        const double size = std::max(sizes_[p], std::abs(series.ds[0][p]) + std::abs(series.dv[0][p]));
        const double term = std::max(std::abs(series.ds[n][p]), std::abs(series.dv[n][p])) / size;
        if (!(term <= worst)) worst = term;  // NaN, too
      }
    }
    return worst;
  }

  ScaledSlip slip_;
  SlipAccuracy accuracy_;
  ScaledGradient sizes_{};
};

/// The time at which a series reaches a level that lies between its values at two times: Newton's steps, halvings where
/// one leaves the bracket.
inline double time_at_level(const Series& series, double level, double low, double high) {
  const double at_low = value_of(series, low) - level;
  double time = 0.5 * (low + high);
  constexpr int kMostSteps = 100;  // halvings alone need 53
  for (int step = 0; step < kMostSteps; ++step) {
    const double excess = value_of(series, time) - level;
    ((excess < 0.0) == (at_low < 0.0) ? low : high) = time;
    double next = time - excess / slope_of(series, time);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const bool is_same = std::abs(next - time) <= 1e-15 * high;
    time = next;
    if (is_same) break;
  }
  return time;
}

/// The instant at which the speed is `level`, which lies between the start of the last step and `last` in it.
template <bool kWithGradient>
SlipNode node_at_speed(const SlipWalker<kWithGradient>& walker, double level, const SlipNode& last) {
  SlipNode node = walker.inside(time_at_level(walker.series.v, level, 0.0, last.tau - walker.from.tau));
  node.state.v = level;
  return node;
}

/// The smallest speed inside the last step, which enters it falling and leaves it rising.
template <bool kWithGradient>
SlipNode node_at_turn(const SlipWalker<kWithGradient>& walker) {
  Series acceleration{};
  for (std::size_t n = 0; n < kSeriesOrder; ++n) {
    acceleration[n] = static_cast<double>(n + 1) * walker.series.v[n + 1];
  }
  return walker.inside(time_at_level(acceleration, 0.0, 0.0, walker.length()));
}

/// Describes what the speed does inside the last step: it comes to rest from above, or it turns back before it does.
struct SpeedEvent {
  std::optional<SlipNode> rest, turn;
};

template <bool kWithGradient>
SpeedEvent speed_event(const SlipWalker<kWithGradient>& walker) {
  if (walker.to.state.v <= 0.0) return {node_at_speed(walker, 0.0, walker.to), std::nullopt};
  if (!(walker.from.acceleration < 0.0 && walker.to.acceleration >= 0.0)) return {};
  const SlipNode turn = node_at_turn(walker);
  // A grazing return: at rest for an instant inside the step although both its ends slide.
  if (turn.state.v <= 0.0) return {node_at_speed(walker, 0.0, turn), std::nullopt};
  return {std::nullopt, turn};
}

/// Resticks, turns back before it has come to rest, or settles to steady sliding.
enum class SlipOutcome { Resticks, TurnsBack, Settles, NotSolved };

/// Only a slip that has been faster than the drive and falls below its speed can stick or turn back: below it the
/// spring gains force, so that what accelerates goes on accelerating. Before that a creeping body only seems to, by
/// round-off.
template <class Walker>
bool falls_below_drive(const Walker& walker) {
  return walker.from.state.v >= 1.0 && walker.to.state.v < 1.0;
}

struct SlipEnd {
  SlipOutcome outcome = SlipOutcome::NotSolved;
  SlipNode node;  ///< where it sticks or is slowest, or where the motion has settled
};

/// Steady sliding is stable and so close that the linear motion about it cannot reach v = 0 any more.
inline bool has_settled(const ScaledSlip& slip, const SlipState& state) {
  const double distance = std::abs(state.v - 1.0) + std::abs(state.s - slip.steady_s());
  return distance * (1.0 + std::abs(slip.law.rate)) < 1e-6 && slip.total_damping_ratio() > 0.0;
}

/// Follows the slip from stick until the mass is at rest again, or has turned back before, or has settled. One turn
/// decides: orbits of two variables do not cross, so what has turned back once stays inside its own loop, docs/model.md
/// (16). `after_step(walker)` is called after each step. There is no step where an overdamped slip cannot even slow
/// down to the driving speed again, which would take thousands of stiff steps to see.
template <bool kWithGradient, class AfterStep>
SlipEnd follow_slip(const ScaledSlip& slip, const SlipAccuracy& accuracy, const AfterStep& after_step) {
  if (!(2.0 * slip.zeta + slip.law.smallest_slope_of_fast_slip() < 2.0)) return {SlipOutcome::Settles, {}};
  SlipWalker<kWithGradient> walker(slip, accuracy);
  bool slows_down = false;
  for (int step = 0; step < accuracy.most_steps && walker.advance(); ++step) {
    after_step(walker);
    slows_down = slows_down || falls_below_drive(walker);
    const SpeedEvent event = slows_down ? speed_event(walker) : SpeedEvent();
    if (event.rest) return {SlipOutcome::Resticks, *event.rest};
    if (event.turn) return {SlipOutcome::TurnsBack, *event.turn};
    if (has_settled(slip, walker.to.state)) return {SlipOutcome::Settles, walker.to};
  }
  return {};
}

struct TracePoint {
  double s = 0.0;
  double v = 0.0;
};

/// One slip and the stick after it, asked at times that never decrease.
class SlipTrace {
 public:
  explicit SlipTrace(const ScaledSlip& slip) : walker_(slip, kExact) {}

  /// Returns the motion at tau; it is empty where the slip runs away or needs steps without end.
  std::optional<TracePoint> at(double tau) {
    while (!rest_ && walker_.to.tau < tau) {
      // Steps of 0.01 on average: too stiff.
      if (++steps_ > 20000.0 + 100.0 * tau || !walker_.advance()) return std::nullopt;
      slows_down_ = slows_down_ || falls_below_drive(walker_);
      if (slows_down_) rest_ = speed_event(walker_).rest;
    }
    if (rest_ && tau >= rest_->tau) return TracePoint{rest_->state.s + (tau - rest_->tau), 0.0};
    if (walker_.length() <= 0.0) return TracePoint{walker_.to.state.s, walker_.to.state.v};  // before the first step
    const SlipState state = walker_.series.at(tau - walker_.from.tau);
    return TracePoint{state.s, state.v};
  }

  /// Known as soon as a time after it has been asked for.
  [[nodiscard]] std::optional<double> tau_end() const { return rest_ ? std::optional(rest_->tau) : std::nullopt; }

 private:
  SlipWalker<false> walker_;
  bool slows_down_ = false;
  std::optional<SlipNode> rest_;
  double steps_ = 0.0;
};

/// Spring force above F_k(0+) in units of k V / w_n with its derivatives at fixed tau: WavePoint (slip.hpp) with two
/// derivatives more.
struct TrackPoint {
  double z = 0.0, d_tau = 0.0, d_z0 = 0.0, d_zeta = 0.0, d_slope = 0.0, d_rate = 0.0;
};

/// A value and its derivatives at fixed tau.
struct TrackValue {
  double value = 0.0, d_z0 = 0.0, d_zeta = 0.0, d_slope = 0.0, d_rate = 0.0;
};

/// Describes the end of the slip: z' = 1 where it sticks again, else z'' = 0.
struct TrackEnd {
  double tau = 0.0;
  TrackValue first, second;  ///< z', z''
  double third = 0.0;        ///< z'''
};

/// One cycle with friction that depends on the sliding speed, for fits: the slip above to 1e-7, with its
/// derivatives, at any time. In z = s - 2 zeta:
///   z'' + 2 zeta z' + z = g(v) = slope (exp(rate v) - 1) / rate,  v = 1 - z',  z(0) = z0, z'(0) = 1
/// (docs/model.md section 5): slope = b w_n / k with b the slope of F_k(v) at v = 0, rate = alpha V. At rate 0 friction
/// is linear in the speed and adds slope / 2 to zeta. The slip ends where z' = 1 again or, where it does not stick, at
/// its smallest sliding speed, as Slip does.
class VelocityTrack {
 public:
  /// Solves the slip. It is empty where the slip has no start (z0 + 2 zeta <= 0), is not finite, runs away, settles
  /// without turning back, or is stiffer than any that a recording shows: friction that grows by more than exp(10)
  /// within the slip.
  static std::optional<VelocityTrack> solve(double z0, double zeta, double slope, double rate) {
    return solve(z0, zeta, ScaledLaw{slope, rate});
  }
  static std::optional<VelocityTrack> solve(double z0, double zeta, const ScaledLaw& law);

  /// The whole cycle: tau < 0 is the stick before, tau > tau_end() the stick after.
  [[nodiscard]] TrackPoint at(double tau) const;
  /// Returns the force that spring and damper carry together, z + 2 zeta z'.
  [[nodiscard]] TrackPoint transmitted_at(double tau) const;
  /// Returns the integral of what `at` gives, and of its derivatives, from the onset to any time; `d_tau` is z itself.
  [[nodiscard]] TrackPoint integral_to(double tau) const;
  /// Returns the same integral of what `transmitted_at` gives.
  [[nodiscard]] TrackPoint transmitted_integral_to(double tau) const;
  [[nodiscard]] bool resticks() const { return resticks_; }
  [[nodiscard]] double tau_end() const { return end_.tau; }
  /// The parts of the slip, of what `at` or `transmitted_at` gives.
  [[nodiscard]] std::vector<SlipPart> parts(bool transmitted) const;
  /// The start of the part in which the slip is fastest at its start.
  [[nodiscard]] double fastest_tau() const;
  /// After the slip z = value + tau.
  [[nodiscard]] const TrackValue& after() const { return after_; }
  [[nodiscard]] const TrackEnd& end() const { return end_; }

 private:
  struct Step {
    double begin = 0.0;
    double integral = 0.0;            ///< of s from the onset to the start
    ScaledGradient integral_of_ds{};  ///< of its derivatives
    SlipSeries<true> series;
  };

  void keep(const SlipNode& begin, const SlipSeries<true>& series);
  void finish(const SlipNode& end);
  [[nodiscard]] const Step& step_at(double tau) const;
  [[nodiscard]] TrackPoint inside(double tau) const;
  [[nodiscard]] TrackPoint slope_inside(double tau) const;

  ScaledSlip slip_;
  bool resticks_ = false;
  TrackValue after_;
  TrackEnd end_;
  std::vector<Step> steps_;
};

}  // namespace slipfit::model
