#include <algorithm>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4_controller.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4_dense_output.hpp>
#include <cmath>
#include <exception>
#include <utility>

#include "rivals.hpp"
#include "track.hpp"

namespace atlas {
namespace {

namespace odeint = boost::numeric::odeint;
using Vector = boost::numeric::ublas::vector<double>;
using Matrix = boost::numeric::ublas::matrix<double>;

constexpr double kStuckWidths = 5.0;  // creep slower than this is what smoothing makes of stick

struct SmoothedFriction {
  double value = 0.0, d_speed = 0.0;
};

/// Sliding speed over which the static peak decays: many widths, for tanh to reach the peak, and yet small.
double peak_speed(double width) {
  return std::sqrt(width);
}

/// Above F_k(0+).
SmoothedFriction smoothed(const ForwardScene& scene, double v, double width) {
  const double kinetic = kKineticShare * scene.lambda;
  const double turn = std::tanh(v / width);
  const double peak = scene.lambda * std::exp(-std::abs(v) / peak_speed(width));
  const double whole = kinetic + peak + friction_above(scene, std::abs(v));
  const double d_whole =
      std::copysign(1.0, v) * (-peak / peak_speed(width) + scene.slope * std::exp(scene.rate * std::abs(v)));
  return {whole * turn - kinetic, d_whole * turn + whole * (1.0 - turn * turn) / width};
}

}  // namespace

Answer run_smoothed(const ForwardScene& scene, const WaveTimes& times, double width) {
  const auto rates = [&](const Vector& x, Vector& dx, double) {
    dx[0] = x[1];
    dx[1] = -x[0] - 2.0 * scene.zeta * x[1] + smoothed(scene, 1.0 - x[1], width).value;
  };
  const auto jacobian = [&](const Vector& x, Matrix& j, double, Vector& by_time) {
    j(0, 0) = 0.0;
    j(0, 1) = 1.0;
    j(1, 0) = -1.0;
    j(1, 1) = -2.0 * scene.zeta - smoothed(scene, 1.0 - x[1], width).d_speed;
    by_time[0] = by_time[1] = 0.0;
  };
  const double tolerance = std::min(1e-6, 0.01 * width);
  auto stepper = odeint::make_dense_output(tolerance, tolerance, odeint::rosenbrock4<double>());
  Vector state(2);
  state[0] = scene.lambda - 2.0 * scene.zeta;
  state[1] = 1.0 - peak_speed(width);  // over the peak: at rest it would creep up to it first
  stepper.initialize(state, 0.0, width);
  Track track(times);
  try {
    while (!track.finished()) {
      const auto [from, to] = stepper.do_step(std::make_pair(rates, jacobian));
      for (int i = 1; i <= 4; ++i) {
        const double tau = from + (to - from) * 0.25 * i;
        stepper.calc_state(tau, state);
        track.add({tau, state[0], state[1], std::abs(1.0 - state[1]) < kStuckWidths * width});
      }
    }
  } catch (const std::exception&) {
    return {};
  }
  return track.answer();
}

}  // namespace atlas
