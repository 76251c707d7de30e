#include "fit/observation/sensor_lag.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "scene.hpp"

using namespace slipfit;

namespace {

constexpr double kOversampling = 40.0;

/// The scene as a first-order sensor shows it: simulated 40 times finer, filtered exactly for a force that is straight
/// between those samples (first-order hold), thinned out, noise added.
Recording through_sensor(Scene s, double lag_s) {
  const double noise_N = s.noise * (s.static_N - s.kinetic_N);
  s.noise = 0.0;
  s.samples_per_slip *= kOversampling;
  const Recording fine = record(s);
  const auto time_s = fine.time_s();
  const auto force = fine.force();
  const double step = (time_s[1] - time_s[0]) / lag_s;
  const double decay = std::exp(-step);
  const double share = (1.0 - decay) / step;
  std::mt19937_64 random(s.seed);
  std::normal_distribution<double> noise(0.0, noise_N);
  std::vector<double> seen_s;
  std::vector<double> seen;
  double shown = force[0];
  for (std::size_t i = 1; i < force.size(); ++i) {
    shown = decay * shown + (1.0 - share) * force[i] + (share - decay) * force[i - 1];
    if (i % static_cast<std::size_t>(kOversampling) != 0) continue;
    seen_s.push_back(time_s[i]);
    seen.push_back(shown + noise(random));
  }
  return Recording::create(std::move(seen_s), std::move(seen), fine.conditions()).value();
}

void check(const Analysis& analysis, const char* name, double truth) {
  INFO(name);
  const Estimate& e = parameter(analysis, name).estimate;
  REQUIRE(e.value);
  CHECK(std::abs(*e.value - truth) < 4.0 * *e.standard_error);  // 1 in 16 000 by chance
}

}  // namespace

TEST_CASE("a slip seen through a slow sensor gives its parameters back") {
  Scene s;
  s.noise = 0.01;
  s.jitter = 0.03;
  const double lag = GENERATE(0.1, 0.5, 1.5);  // w_n T
  SECTION("spring") {}
  SECTION("transmitted") {
    s.view = ForceView::Transmitted;
  }
  SECTION("little damping") {
    s.zeta = 0.01;
  }
  const double lag_s = lag / s.omega;
  INFO("w_n T = " << lag);
  s.conditions.sensor_bandwidth_Hz = 1.0 / (2.0 * std::numbers::pi * lag_s);
  const Analysis analysis = analyze_and_fit(through_sensor(s, lag_s), {});
  REQUIRE(analysis.verdict == Verdict::StickSlip);
  check(analysis, "stiffness_N_per_m", s.stiffness);
  check(analysis, "natural_frequency_rad_per_s", s.omega);
  check(analysis, "damping_ratio", s.zeta);
  check(analysis, "friction_difference_N", s.static_N - s.kinetic_N);
  CHECK_FALSE(has_warning(analysis, "model_misfit"));
}

TEST_CASE("without the stated bandwidth the same slip gives another natural frequency") {
  Scene s;
  s.noise = 0.01;
  s.jitter = 0.03;
  const Analysis analysis = analyze_and_fit(through_sensor(s, 0.3 / s.omega), {});
  // What docs/accuracy.md says that it costs: 5 % of w_n at w_n T = 0.3.
  CHECK(*parameter(analysis, "natural_frequency_rad_per_s").estimate.value == Approx(0.95 * s.omega).epsilon(0.01));
}

TEST_CASE("a sensor that has not forgotten one slip when the next begins is warned of") {
  Scene s;
  s.noise = 0.01;
  s.speed = 0.03;
  const double lag_s = 2.0 / s.omega;
  s.conditions.sensor_bandwidth_Hz = 1.0 / (2.0 * std::numbers::pi * lag_s);
  const Analysis analysis = analyze_and_fit(through_sensor(s, lag_s), {});
  CHECK(has_warning(analysis, "sensor_too_slow"));
  // Left over from the slip before, its tail would draw k off by 10 of its standard errors.
  if (analysis.verdict == Verdict::StickSlip) check(analysis, "stiffness_N_per_m", s.stiffness);
}

TEST_CASE("a sensor much faster than the slip shows the slip itself") {
  const model::Slip slip = model::solve_slip(8.0, 0.06);
  const fit::SensorLag fast{1e-5, false};
  for (const double tau : {-0.5, 0.3, 1.0, 2.0, slip.tau_end - 0.01}) {
    const double exact = tau < 0.0 ? slip.z0 + tau : model::slip_wave(slip, tau).z;
    const double slope = tau < 0.0 ? 1.0 : model::slip_wave(slip, tau).d_tau;
    CHECK(fast.wave_at(slip, tau).z == Approx(exact - 1e-5 * slope).epsilon(1e-8));  // lags by T, to first order
  }
}
