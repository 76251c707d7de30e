#include "support/sensitivity.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "support/waveform.hpp"

using namespace slipfit;

namespace {

using Values = std::array<double, kSensitivityParameters>;

Slider slider_of(const Values& p) {
  return Slider::create(p[kStiffness], p[kNaturalFrequency], p[kDampingRatio]).value();
}
Friction friction_of(const Values& p) {
  return Friction::create(p[kStaticFriction], p[kKineticFriction]).value();
}

/// Fourth-order central difference of f along parameter i: error h^4 f^(5) / 30 and round-off 1e-16 f / h.
template <class F>
double difference(const F& f, const Values& p, std::size_t i, double relative_step) {
  const double h = relative_step * p[i];
  const auto at = [&](double steps) {
    Values q = p;
    q[i] += steps * h;
    return f(q);
  };
  return (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * h);
}

Values random_values(std::mt19937_64& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Values p{};
  p[kStiffness] = uniform(100.0, 5000.0);
  p[kNaturalFrequency] = uniform(20.0, 800.0);
  p[kDampingRatio] = uniform(0.01, 0.4);
  p[kKineticFriction] = uniform(0.5, 3.0);
  p[kStaticFriction] = p[kKineticFriction] + uniform(0.3, 2.0);
  const double lambda = critical_lambda(p[kDampingRatio]) * uniform(1.3, 30.0);
  p[kDrivingSpeed] = p[kNaturalFrequency] * (p[kStaticFriction] - p[kKineticFriction]) / (p[kStiffness] * lambda);
  return p;
}

}  // namespace

TEST_CASE("derivatives of times and forces agree with fourth-order differences") {
  std::mt19937_64 random(17);
  for (int trial = 0; trial < 100; ++trial) {
    const Values p = random_values(random);
    const auto exact = damped_sensitivity(slider_of(p), friction_of(p), p[kDrivingSpeed]);
    REQUIRE(exact);
    const LimitCycle cycle = *damped_motion(slider_of(p), friction_of(p), p[kDrivingSpeed]).cycle;
    const auto check = [&](const Sensitive& sensitive, double LimitCycle::*member) {
      CHECK(sensitive.value == Approx(cycle.*member).epsilon(1e-13).margin(1e-13));
      const auto f = [&](const Values& q) {
        return (*damped_motion(slider_of(q), friction_of(q), q[kDrivingSpeed]).cycle).*member;
      };
      for (std::size_t i = 0; i < kSensitivityParameters; ++i) {
        INFO("trial " << trial << " parameter " << i);
        const double size = std::abs(cycle.*member) / p[i];
        CHECK(sensitive.gradient[i] == Approx(difference(f, p, i, 2e-4)).epsilon(1e-7).margin(1e-7 * size));
      }
    };
    check(exact->slip_s, &LimitCycle::slip_s);
    check(exact->stick_s, &LimitCycle::stick_s);
    check(exact->period_s, &LimitCycle::period_s);
    check(exact->periodic_displacement_m, &LimitCycle::periodic_displacement_m);
    check(exact->force_peak_N, &LimitCycle::force_peak_N);
    check(exact->force_trough_N, &LimitCycle::force_trough_N);
    check(exact->onset_force_N, &LimitCycle::onset_force_N);
    check(exact->end_force_N, &LimitCycle::end_force_N);
  }
}

TEST_CASE("energy: what the drive gives, kinetic friction and the damper take") {
  std::mt19937_64 random(31);
  for (int trial = 0; trial < 30; ++trial) {
    const Values p = random_values(random);
    const Slider slider = slider_of(p);
    const LimitCycle cycle = *damped_motion(slider, friction_of(p), p[kDrivingSpeed]).cycle;
    const std::size_t count = 20000;
    const double step_s = cycle.period_s / static_cast<double>(count);
    const auto waveform = [&](ForceView view) {
      return *damped_waveform(slider, friction_of(p), p[kDrivingSpeed], view, {0.0, step_s, count});
    };
    const auto spring_N = waveform(ForceView::Spring);
    const auto transmitted_N = waveform(ForceView::Transmitted);
    const double c = slider.damping_N_s_per_m();
    double mean_N = 0.0;
    double damper_J = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      mean_N += spring_N[i] / static_cast<double>(count);
      const double rate = (transmitted_N[i] - spring_N[i]) / c;  // u', the speed of the damper
      damper_J += c * rate * rate * step_s;
    }
    // Trapezoids on a periodic trace with kinks: step^2, here 1e-8 of the force range.
    CHECK(mean_N == Approx(cycle.mean_force_N).epsilon(1e-6));
    const double drive_J = cycle.mean_force_N * cycle.periodic_displacement_m;
    CHECK(drive_J == Approx(p[kKineticFriction] * cycle.periodic_displacement_m + damper_J).epsilon(1e-6));
  }
}

TEST_CASE("finite valid parameters never give a number that is not finite") {
  std::mt19937_64 random(37);
  const auto log_uniform = [&](double low, double high) {
    return std::exp(std::uniform_real_distribution<double>(std::log(low), std::log(high))(random));
  };
  int bad = 0;
  int cycles = 0;
  for (int i = 0; i < 1000000; ++i) {
    const double zeta = i % 10 == 0 ? 0.0 : log_uniform(1e-9, 10.0);
    const auto slider = Slider::create(log_uniform(1e-6, 1e12), log_uniform(1e-4, 1e8), zeta);
    const double kinetic_N = i % 7 == 0 ? 0.0 : log_uniform(1e-9, 1e6);
    const auto friction = Friction::create(kinetic_N + log_uniform(1e-12, 1e6), kinetic_N);
    const Motion motion = damped_motion(slider.value(), friction.value(), log_uniform(1e-12, 1e4));
    if (!std::isfinite(motion.lambda)) ++bad;
    if (!motion.cycle) continue;
    ++cycles;
    const LimitCycle& c = *motion.cycle;
    for (const double value : {c.slip_s, c.stick_s, c.period_s, c.sticking_degree, c.periodic_displacement_m,
                               c.force_peak_N, c.force_trough_N, c.onset_force_N, c.end_force_N, c.mean_force_N}) {
      if (!std::isfinite(value)) ++bad;
    }
    if (!(c.slip_s > 0.0 && c.stick_s > 0.0 && c.sticking_degree <= 1.0)) ++bad;
  }
  CHECK(bad == 0);
  CHECK(cycles > 100000);
}
