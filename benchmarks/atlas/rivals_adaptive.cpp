#include <algorithm>
#include <array>
#include <boost/numeric/odeint/algebra/array_algebra.hpp>
#include <boost/numeric/odeint/util/bind.hpp>
#include <boost/numeric/odeint/util/unwrap_reference.hpp>

#include <boost/numeric/odeint/stepper/dense_output_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <exception>

#include "rivals.hpp"
#include "track.hpp"

namespace atlas {
namespace {

namespace odeint = boost::numeric::odeint;
using State = std::array<double, 2>;  // z, z'
using Dopri5 = odeint::runge_kutta_dopri5<State, double, State, double, odeint::array_algebra>;

constexpr int kDenseNodes = 4;  // a step: cubics between them are finer than the dense output itself
constexpr double kFirstStep = 0.01;

auto dense_stepper(double tolerance) {
  return odeint::make_dense_output(tolerance, tolerance, Dopri5());
}

/// Latest time of the step at which the body still slides forwards.
template <class Stepper>
double end_of_slip(Stepper& stepper, double from, double to) {
  constexpr int kHalvings = 48;
  State state{};
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (from + to);
    stepper.calc_state(middle, state);
    (state[1] < 1.0 ? from : to) = middle;
  }
  return to;
}

template <class Stepper>
void add_nodes(Track& track, Stepper& stepper, double from, double to) {
  State state{};
  for (int i = 1; i <= kDenseNodes; ++i) {
    const double tau = from + (to - from) * i / kDenseNodes;
    stepper.calc_state(tau, state);
    track.add({tau, state[0], state[1], false});
  }
}

}  // namespace

Answer run_event_location(const ForwardScene& scene, const WaveTimes& times, double tolerance) {
  const auto system = [&scene](const State& x, State& dx, double) {
    dx = {x[1], -x[0] - 2.0 * scene.zeta * x[1] + friction_above(scene, 1.0 - x[1])};
  };
  const double onset = scene.lambda - 2.0 * scene.zeta;
  auto stepper = dense_stepper(tolerance);
  stepper.initialize(State{onset, 1.0}, 0.0, kFirstStep);
  Track track(times);
  track.add({0.0, onset, 1.0, false});
  while (!track.finished()) {
    const auto [from, to] = stepper.do_step(system);
    const bool comes_to_rest = stepper.current_state()[1] >= 1.0;
    const double end = comes_to_rest ? end_of_slip(stepper, from, to) : to;
    add_nodes(track, stepper, from, end);
    if (!comes_to_rest) continue;
    State rest{};
    stepper.calc_state(end, rest);
    track.add({end, rest[0], 1.0, true});
    const double next = end + onset - rest[0];
    track.add({next, onset, 1.0, true});
    stepper.initialize(State{onset, 1.0}, next, kFirstStep);
  }
  return track.answer();
}

Answer run_switch_model(const ForwardScene& scene, const WaveTimes& times, double band) {
  const auto system = [&scene, band](const State& x, State& dx, double) {
    const double speed = 1.0 - x[1];
    const double push = x[0] + 2.0 * scene.zeta * x[1];
    double acceleration = push - scene.lambda;  // leaving the band
    if (speed > band) {
      acceleration = push - friction_above(scene, speed);
    } else if (speed < -band) {
      acceleration = push + 2.0 * kKineticShare * scene.lambda + friction_above(scene, -speed);
    } else if (push <= scene.lambda) {
      acceleration = -speed;  // stick: drawn to rest
    }
    dx = {x[1], -acceleration};
  };
  const double onset = scene.lambda - 2.0 * scene.zeta;
  // The band is passed in one go from rest, as Leine's own start does; tolerance well inside the band.
  auto stepper = dense_stepper(0.01 * band);
  stepper.initialize(State{onset, 1.0 - 2.0 * band}, 0.0, band);
  Track track(times);
  track.add({0.0, onset, 1.0, false});
  try {
    while (!track.finished()) {
      const auto [from, to] = stepper.do_step(system);
      add_nodes(track, stepper, from, to);
      const State& now = stepper.current_state();
      track.add({to, now[0], now[1], std::abs(1.0 - now[1]) <= band});
    }
  } catch (const std::exception&) {  // odeint's way to say that the step shrank to nothing
    return {};
  }
  return track.answer();
}

}  // namespace atlas
