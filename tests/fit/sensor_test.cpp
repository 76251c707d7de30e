#include "fit/observation/sensor.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "fit/law/coulomb.hpp"
#include "fit/observation/averaged_slip.hpp"
#include "model/reference_table.hpp"
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

/// The scene as a logger shows it that averages over so many samples: simulated 40 times finer.
Recording averaged(Scene s, double samples) {
  const double noise_N = s.noise * (s.static_N - s.kinetic_N);
  s.noise = 0.0;
  s.samples_per_slip *= kOversampling;
  const Recording fine = record(s);
  const auto force = fine.force();
  const auto reach = static_cast<std::size_t>(0.5 * samples * kOversampling);
  std::mt19937_64 random(s.seed);
  std::normal_distribution<double> noise(0.0, noise_N);
  std::vector<double> sum{0.0};
  for (const double f : force) sum.push_back(sum.back() + f);
  std::vector<double> seen_s;
  std::vector<double> seen;
  for (std::size_t i = reach; i + reach + 1 < sum.size(); i += static_cast<std::size_t>(kOversampling)) {
    seen_s.push_back(fine.time_s()[i]);
    seen.push_back((sum[i + reach + 1] - sum[i - reach]) / static_cast<double>(2 * reach + 1) + noise(random));
  }
  return Recording::create(std::move(seen_s), std::move(seen), fine.conditions()).value();
}

}  // namespace

TEST_CASE("a slip seen through a slow sensor gives its parameters back") {
  Scene s{.jitter = 0.03, .noise = 0.01};
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
  const Analysis analysis = analyze_and_fit(through_sensor(s, lag_s));
  REQUIRE(analysis.motion == MotionClass::StickSlip);
  check_truth(analysis, s);
  CHECK_FALSE(has_warning(analysis, "model_misfit"));
}

TEST_CASE("without the stated bandwidth the same slip gives another natural frequency") {
  const Scene s{.jitter = 0.03, .noise = 0.01};
  const Analysis analysis = analyze_and_fit(through_sensor(s, 0.3 / s.omega));
  const Parameter& frequency = parameter(analysis, "natural_frequency_rad_per_s");
  // What docs/accuracy.md says that it costs: 5 % of w_n at w_n T = 0.3.
  CHECK(*frequency.estimate.value == Approx(0.95 * s.omega).epsilon(0.01));
  // Friction that weakens and an average explain such slips, too: the interval holds what they say.
  CHECK(frequency.status == ParameterStatus::Weak);
  CHECK(frequency.estimate.ci95->high > s.omega);
}

TEST_CASE("a sensor that has not forgotten one slip when the next begins is warned of") {
  Scene s{.speed = 0.03, .noise = 0.01};
  const double lag_s = 2.0 / s.omega;
  s.conditions.sensor_bandwidth_Hz = 1.0 / (2.0 * std::numbers::pi * lag_s);
  const Analysis analysis = analyze_and_fit(through_sensor(s, lag_s));
  CHECK(has_warning(analysis, "sensor_too_slow"));
  // Left over from the slip before, its tail would draw k off by 10 of its standard errors.
  if (analysis.motion == MotionClass::StickSlip) check_truth(analysis, "stiffness_N_per_m", s.stiffness);
}

TEST_CASE("a sensor much faster than the slip shows the slip itself") {
  const model::Slip slip = model::solve_slip(8.0, 0.06);
  const fit::Sensor fast{1e-5};
  for (const double tau : {-0.5, 0.3, 1.0, 2.0, slip.tau_end - 0.01}) {
    const double exact = tau < 0.0 ? slip.z0 + tau : model::slip_wave(slip, tau).z;
    const double slope = tau < 0.0 ? 1.0 : model::slip_wave(slip, tau).d_tau;
    CHECK(fit::SensedSlip(fast, slip).at(tau).z ==
          Approx(exact - 1e-5 * slope).epsilon(1e-8));  // lags by T, to first order
  }
}

TEST_CASE("a moving average of the limit cycle is that of numerical integration") {
  for (const auto& row : test::reference_rows("sensor_average.csv")) {
    const double lambda = row.at("lambda");
    const double zeta = row.at("zeta");
    const double tau = row.at("tau");
    // The table is of the periodic motion: only windows that reach into no other slip compare.
    if (tau + 0.5 * row.at("window") > row.at("t_slip") + row.at("t_stick")) continue;
    if (tau - 0.5 * row.at("window") < -row.at("t_stick")) continue;
    const model::Slip slip = model::solve_slip(lambda - 2.0 * zeta, zeta);
    CAPTURE(lambda, zeta, row.at("window"), tau);
    // Differences of integrals of size lambda^2, over the window, keep 1e-16 of them.
    const double expected = row.at("average");
    const fit::Sensor logger{0.0, row.at("window")};
    CHECK(fit::SensedSlip(logger, slip).at(tau).z == Approx(expected).margin(1e-12 * (1.0 + lambda)));
    const fit::AveragedSlip averaged(slip, model::stick_after(slip), row.at("window"), false);
    CHECK(averaged.at(tau).z == Approx(expected).margin(1e-12 * (1.0 + lambda)));
  }
}

TEST_CASE("a stated averaging gives the parameters back, and unstated it is seen, and nothing of the slip is sure") {
  const Scene s{.jitter = 0.03, .noise = 0.01};
  constexpr double kSamples = 8.0;  // of 30 in a slip: w_n is 4 % too small without it
  const Recording shown = averaged(s, kSamples);
  SECTION("stated") {
    Conditions conditions = shown.conditions();
    conditions.sensor_average_s = kSamples * shown.sample_interval_s();
    const Recording stated = Recording::create({shown.time_s().begin(), shown.time_s().end()},
                                               {shown.force().begin(), shown.force().end()}, conditions)
                                 .value();
    const Analysis analysis = analyze_and_fit(stated);
    check_truth(analysis, s);
    CHECK(parameter(analysis, "natural_frequency_rad_per_s").status == ParameterStatus::Conditional);
    CHECK(parameter(analysis, "sensor_average_s").status == ParameterStatus::Fixed);
    CHECK_FALSE(has_warning(analysis, "samples_averaged"));
  }
  SECTION("unstated") {
    const Analysis analysis = analyze_and_fit(shown);
    CHECK(has_warning(analysis, "samples_averaged"));
    const Parameter& omega = parameter(analysis, "natural_frequency_rad_per_s");
    CHECK(omega.status == ParameterStatus::Weak);
    // One recording: one in twenty lies outside the interval, one in four hundred outside three standard errors.
    CHECK(std::abs(*omega.estimate.value - s.omega) < 3.0 * *omega.estimate.standard_error);
    CHECK(parameter(analysis, "mass_kg").status == ParameterStatus::Weak);
  }
}

TEST_CASE("an average without a lag is the same by either class") {
  const double zeta = GENERATE(-0.05, 0.0, 0.1, 0.6);
  const bool transmitted = GENERATE(false, true);
  const double average = GENERATE(0.3, 2.0, 6.0);
  const model::Slip slip = model::solve_slip(8.0, zeta);
  CAPTURE(zeta, transmitted, average);
  const fit::SensedSlip sensed({0.0, average, transmitted}, slip);
  const fit::AveragedSlip averaged(slip, model::stick_after(slip), average, transmitted);
  constexpr double kStep = 0.05;
  const fit::CoulombCycle cycle(8.0, zeta, {0.0, average, transmitted});
  fit::CoulombCycle::Samples samples(cycle, kStep);
  for (int i = 0; i * kStep < slip.tau_end + 2.0 * average; ++i) {
    if (i % 7 == 3) continue;  // some samples are left out
    const double tau = i * kStep - average;
    const model::WavePoint a = sensed.at(tau);
    for (const model::WavePoint& b : {averaged.at(tau), samples.at(tau)}) {
      CHECK(b.z == Approx(a.z).margin(1e-11));  // rounding
      CHECK(b.d_z0 == Approx(a.d_z0).margin(1e-11));
      CHECK(b.d_zeta == Approx(a.d_zeta).margin(1e-10));
      CHECK(b.d_tau == Approx(a.d_tau).margin(1e-11));
      CHECK(b.d_log_omega == Approx(a.d_log_omega).margin(1e-11));
    }
  }
}
