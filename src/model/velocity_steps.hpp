#pragma once

// Steps of an ordinary differential equation whose component 1 is a speed, and the instants inside a step at which that
// speed reaches a level or comes to rest. Boost.odeint's Fehlberg 7(8) steps; an event is found by repeating the step
// with the length that ends on it, so that it is as exact as the integration itself.

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <boost/numeric/odeint/algebra/array_algebra.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "model/velocity_law.hpp"

namespace slipfit::model {

/// Error of a step against |x| + h |x'| of each component, but never less than its floor.
template <std::size_t N>
struct StepError {
  double tolerance = 1e-12;
  std::array<double, N> floor{};

  template <class Algebra>
  double error(Algebra& /*unused*/, const std::array<double, N>& x, const std::array<double, N>& dx,
               const std::array<double, N>& difference, double step) const {
    double worst = 0.0;
    for (std::size_t i = 0; i < N; ++i) {
      const double size = std::max(std::abs(x[i]) + std::abs(step * dx[i]), floor[i]);
      const double ratio = std::abs(difference[i]) / (tolerance * size);
      if (!(ratio < kHopeless)) return kHopeless;  // odeint would accept a step whose error is NaN
      worst = std::max(worst, ratio);
    }
    return worst;
  }

  static constexpr double kHopeless = 1e30;
};

/// Walks a system forward. `System::longest_step(node)` bounds the step from there, so that the speed turns at most
/// once in it and that nothing happens which only the last stage meets: the error estimate of these steps misses that.
/// The nodes `from` and `to` are the ends of the last step.
template <std::size_t N, class System>
class StepWalker {
  using State = std::array<double, N>;
  using Fehlberg = boost::numeric::odeint::runge_kutta_fehlberg78<State, double, State, double,
                                                                  boost::numeric::odeint::array_algebra>;
  using Controlled = boost::numeric::odeint::controlled_runge_kutta<Fehlberg, StepError<N>>;

 public:
  StepWalker(const System& system, const State& start, const StepError<N>& error, double first_step)
      : system_(system), controlled_(error, {}, kStepper), step_(first_step) {
    to.x = start;
    system_(to.x, to.dx, to.tau);
  }

  StepNode<N> from, to;

  /// False where no step length serves: the solution runs away.
  bool advance() {
    from = to;
    step_ = std::min(step_, system_.longest_step(from));
    constexpr int kMaxRejections = 60;  // each shortens the step, at best by a factor 5: 60 reach round-off of tau
    for (int attempt = 0; attempt < kMaxRejections; ++attempt) {
      const auto result = controlled_.try_step(std::cref(system_), from.x, from.dx, to.tau, to.x, step_);
      if (result != boost::numeric::odeint::success) continue;
      system_(to.x, to.dx, to.tau);
      return to.tau > from.tau && std::isfinite(to.dx[kSpeed]);
    }
    return false;
  }

  [[nodiscard]] double length() const { return to.tau - from.tau; }

  /// The last step again, but of this length.
  StepNode<N> inside(double length) {
    StepNode<N> node;
    node.tau = from.tau + length;
    controlled_.stepper().do_step(std::cref(system_), from.x, from.dx, from.tau, node.x, length);
    system_(node.x, node.dx, node.tau);
    return node;
  }

  /// Moves a node by a step so short that the first order is exact.
  void nudge(StepNode<N>& node, double step) {
    node.tau += step;
    for (std::size_t i = 0; i < N; ++i) node.x[i] += step * node.dx[i];
    system_(node.x, node.dx, node.tau);
  }

 private:
  inline static const Fehlberg kStepper{};  ///< copied: a fresh one would be copied with its memory uninitialised

  System system_;
  Controlled controlled_;
  double step_;
};

/// Root in (0, high) of the cubic with these values and slopes at both ends; the values have opposite signs.
inline double cubic_root(double high, double f0, double d0, double f1, double d1) {
  const double a = f0 - f1 + 0.5 * high * (d0 + d1);
  const double b = 3.0 * (f1 - f0) - high * (2.0 * d0 + d1);
  double low_s = 0.0;
  double high_s = 1.0;
  double s = f0 / (f0 - f1);
  for (int step = 0; step < 8; ++step) {
    const double value = f0 + s * (high * d0 + s * (b + s * 2.0 * a));
    ((value < 0.0) == (f0 < 0.0) ? low_s : high_s) = s;
    s -= value / (high * d0 + s * (2.0 * b + s * 6.0 * a));
    if (!(s > low_s && s < high_s)) s = 0.5 * (low_s + high_s);
  }
  return s * high;
}

/// The instant at which the speed is `level`. It lies between the start of the last step and `last`, inside that step.
template <std::size_t N, class System>
StepNode<N> locate_level(StepWalker<N, System>& walker, double level, const StepNode<N>& last) {
  const double start = walker.from.x[kSpeed] - level;
  double low = 0.0;
  double high = last.tau - walker.from.tau;
  double length = cubic_root(high, start, walker.from.dx[kSpeed], last.x[kSpeed] - level, last.dx[kSpeed]);
  StepNode<N> node = last;
  constexpr int kMaxSteps = 60;  // bisection alone needs 53
  for (int step = 0; step < kMaxSteps; ++step) {
    node = walker.inside(length);
    const double excess = node.x[kSpeed] - level;
    const double newton = -excess / node.dx[kSpeed];
    // What is left after the first-order move is (1e-8)^2 of the step.
    if (std::abs(newton) <= 1e-8 * high) {
      walker.nudge(node, newton);
      break;
    }
    ((excess < 0.0) == (start < 0.0) ? low : high) = length;
    length += newton;
    if (!(length > low && length < high)) length = 0.5 * (low + high);
  }
  node.x[kSpeed] = level;
  return node;
}

/// The smallest speed inside the last step, which enters it falling and leaves it rising.
template <std::size_t N, class System>
StepNode<N> locate_turn(StepWalker<N, System>& walker) {
  const auto acceleration = [&](double length) { return walker.inside(length).dx[kSpeed]; };
  std::uintmax_t evaluations = 40;
  // 30 bits: the speed is flat here, its error is the square of that.
  const auto bracket = boost::math::tools::toms748_solve(acceleration, 0.0, walker.length(), walker.from.dx[kSpeed],
                                                         walker.to.dx[kSpeed],
                                                         boost::math::tools::eps_tolerance<double>(30), evaluations);
  return walker.inside(bracket.second);
}

/// What the speed does inside the last step: comes to rest from above, or turns back before it does.
template <std::size_t N>
struct SpeedEvent {
  std::optional<StepNode<N>> rest;
  std::optional<StepNode<N>> turn;
};

template <std::size_t N, class System>
SpeedEvent<N> speed_event(StepWalker<N, System>& walker) {
  if (walker.to.x[kSpeed] <= 0.0) return {locate_level(walker, 0.0, walker.to), std::nullopt};
  if (!(walker.from.dx[kSpeed] < 0.0 && walker.to.dx[kSpeed] >= 0.0)) return {};
  const StepNode<N> turn = locate_turn(walker);
  // A grazing return: at rest for an instant inside the step although both its ends slide.
  if (turn.x[kSpeed] <= 0.0) return {locate_level(walker, 0.0, turn), std::nullopt};
  return {std::nullopt, turn};
}

}  // namespace slipfit::model
