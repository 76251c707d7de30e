#pragma once

// One slip with velocity-dependent friction, scaled (velocity_law.hpp), with or without its sensitivities.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "model/velocity_law.hpp"
#include "model/velocity_steps.hpp"

namespace slipfit::model {

/// How exactly a slip is followed.
struct SlipAccuracy {
  double tolerance;     ///< of a step, over the size of each component
  double longest_step;  ///< at most 1: a third of the half turn in which v turns once
  double layer_share;   ///< of the way to rest, and of the layer there, that a step may cross
  int most_steps;       ///< an ordinary slip needs 10 to 60; one that needs more than these has no solution
};
/// The end of slip to 1e-10, derivatives to 1e-9: local errors add up to a few 1e-12 over a slip. With a share of 0.5
/// the end was good to 2e-10 only.
inline constexpr SlipAccuracy kExact{1e-13, 1.0, 0.3, 5000};
/// To 1e-7, all that fits need; quintic polynomials across steps of 0.5 are good to 4e-7 of the motion. A fit solves
/// many thousand slips: a stiff one gets 1 ms at most.
inline constexpr SlipAccuracy kForFits{1e-9, 0.5, 0.5, 5000};

/// With rate < 0 the friction changes within 1 / |rate| above rest. The error estimate of Fehlberg's steps misses what
/// only the last stage meets, and friction that changes the motion little: the length of a step is bounded so that none
/// enters this layer from far above.
inline double longest_slip_step(const ScaledLaw& law, const SlipAccuracy& accuracy, double v, double acceleration) {
  constexpr double kLayer = 40.0;  // exp(-40) is below round-off
  const bool leaves = acceleration >= 0.0 && law.rate * v < -kLayer;
  if (law.rate >= 0.0 || leaves) return accuracy.longest_step;
  return std::min(accuracy.longest_step, accuracy.layer_share * (v - 1.0 / law.rate) / std::abs(acceleration));
}

/// s' = 1 - v, v' = s - 2 zeta v - g(v), and beside them (N = kSensitive) the derivatives of both equations with
/// respect to the four parameters. docs/model.md section 5.
template <std::size_t N>
struct SlipSystem {
  ScaledSlip slip{};
  SlipAccuracy accuracy{};

  [[nodiscard]] double longest_step(const StepNode<N>& node) const {
    return longest_slip_step(slip.law, accuracy, node.x[kSpeed], node.dx[kSpeed]);
  }

  void operator()(const std::array<double, N>& x, std::array<double, N>& dx, double /*tau*/) const {
    const double v = x[kSpeed];
    const ExcessFriction friction = slip.law.at(v);
    dx[0] = 1.0 - v;
    dx[kSpeed] = x[0] - 2.0 * slip.zeta * v - friction.value;
    if constexpr (N == kPlain) dx[kIntegral] = x[0];
    if constexpr (N == kSensitive) {
      const double damping = 2.0 * slip.zeta + friction.d_speed;
      const std::array<double, kScaledParameters> direct{0.0, 2.0 * v, friction.d_slope, friction.d_rate};
      for (std::size_t p = 0; p < kScaledParameters; ++p) {
        dx[kFirstDs + p] = -x[kFirstDv + p];
        dx[kFirstDv + p] = x[kFirstDs + p] - damping * x[kFirstDv + p] - direct[p];
      }
    }
  }
};

template <std::size_t N>
StepError<N> step_error(const ScaledSlip& slip, const SlipAccuracy& accuracy) {
  StepError<N> error{accuracy.tolerance, {}};
  const double size = 1.0 + slip.lambda;
  error.floor.fill(size);
  if constexpr (N == kSensitive) {
    // Sizes of the sensitivities; those of the law fade where the friction has changed before the slip is under way.
    const double reach = size / (1.0 + std::abs(slip.law.rate) * size);
    const double tiny = 1e-200;  // a law without slope has no sensitivity to its rate: 0 / 0
    const std::array<double, kScaledParameters> sizes{1.0, size, reach,
                                                      std::abs(slip.law.slope) * reach * reach + tiny};
    for (std::size_t p = 0; p < kScaledParameters; ++p) {
      error.floor[kFirstDs + p] = error.floor[kFirstDv + p] = sizes[p];
    }
  }
  return error;
}

template <std::size_t N>
using SlipWalker = StepWalker<N, SlipSystem<N>>;

/// A slip from stick. The first step must not jump over the layer at rest either; v grows as lambda tau.
template <std::size_t N>
SlipWalker<N> walk_slip(const ScaledSlip& slip, const SlipAccuracy& accuracy = kExact) {
  std::array<double, N> start{};
  start[0] = slip.lambda;
  if constexpr (N == kSensitive) {  // s(0) = z0 + 2 zeta
    start[kFirstDs] = 1.0;
    start[kFirstDs + 1] = 2.0;
  }
  const double first_step = 0.1 / (1.0 + std::abs(slip.law.rate) * (1.0 + slip.lambda));
  return {SlipSystem<N>{slip, accuracy}, start, step_error<N>(slip, accuracy), first_step};
}

/// Resticks, turns back before it has come to rest, or settles to steady sliding.
enum class SlipOutcome { Resticks, TurnsBack, Settles, NotSolved };

/// Only a slip that has been faster than the drive and falls below its speed can stick or turn back: below it the
/// spring gains force, so that what accelerates goes on accelerating. Before that a creeping body only seems to, by
/// round-off.
template <class Walker>
bool falls_below_drive(const Walker& walker) {
  return walker.from.x[kSpeed] >= 1.0 && walker.to.x[kSpeed] < 1.0;
}

template <std::size_t N>
struct SlipEnd {
  SlipOutcome outcome = SlipOutcome::NotSolved;
  StepNode<N> node;  ///< where it sticks or is slowest, or where the motion has settled
};

/// Steady sliding is stable and so close that the linear motion about it cannot reach v = 0 any more.
template <std::size_t N>
bool has_settled(const ScaledSlip& slip, const StepNode<N>& node) {
  const double distance = std::abs(node.x[kSpeed] - 1.0) + std::abs(node.x[0] - slip.steady_s());
  return distance * (1.0 + std::abs(slip.law.rate)) < 1e-6 && slip.total_damping_ratio() > 0.0;
}

/// From stick until the mass is at rest again, or has turned back before, or has settled. One turn decides: orbits of
/// two variables do not cross, so what has turned back once stays inside its own loop, docs/model.md (16).
/// `after_step(walker)` is called after each step; there is none where an overdamped slip cannot even slow down to the
/// driving speed again, which would take thousands of stiff steps to see.
template <std::size_t N, class AfterStep>
SlipEnd<N> follow_slip(const ScaledSlip& slip, const SlipAccuracy& accuracy, const AfterStep& after_step) {
  if (!(2.0 * slip.zeta + slip.law.smallest_slope_of_fast_slip() < 2.0)) return {SlipOutcome::Settles, {}};
  SlipWalker<N> walker = walk_slip<N>(slip, accuracy);
  bool slows_down = false;
  for (int step = 0; step < accuracy.most_steps && walker.advance(); ++step) {
    after_step(walker);
    slows_down = slows_down || falls_below_drive(walker);
    const SpeedEvent<N> event = slows_down ? speed_event(walker) : SpeedEvent<N>();
    if (event.rest) return {SlipOutcome::Resticks, *event.rest};
    if (event.turn) return {SlipOutcome::TurnsBack, *event.turn};
    if (has_settled(slip, walker.to)) return {SlipOutcome::Settles, walker.to};
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
  explicit SlipTrace(const ScaledSlip& slip) : walker_(walk_slip<kPlain>(slip)) {}

  /// Empty where the slip runs away or needs steps without end.
  std::optional<TracePoint> at(double tau) {
    while (!rest_ && walker_.to.tau < tau) {
      // Steps of 0.01 on average: too stiff.
      if (++steps_ > 5000.0 + 100.0 * tau || !walker_.advance()) return std::nullopt;
      slows_down_ = slows_down_ || falls_below_drive(walker_);
      if (slows_down_) rest_ = speed_event(walker_).rest;
    }
    if (rest_ && tau >= rest_->tau) return TracePoint{rest_->x[0] + (tau - rest_->tau), 0.0};
    if (walker_.length() <= 0.0) return TracePoint{walker_.to.x[0], walker_.to.x[kSpeed]};  // before the first step
    const StepNode<kPlain> node = walker_.inside(tau - walker_.from.tau);
    return TracePoint{node.x[0], node.x[kSpeed]};
  }

  /// Known as soon as a time after it has been asked for.
  [[nodiscard]] std::optional<double> tau_end() const { return rest_ ? std::optional(rest_->tau) : std::nullopt; }

 private:
  SlipWalker<kPlain> walker_;
  bool slows_down_ = false;
  std::optional<StepNode<kPlain>> rest_;
  double steps_ = 0.0;
};

}  // namespace slipfit::model
