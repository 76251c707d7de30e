#include <ceres/jet.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "fit/level/level_model.hpp"
#include "fit/scene.hpp"
#include "model/reloading.hpp"
#include "model/slip.hpp"
#include "slipfit/predict/prediction.hpp"
#include "slipfit/sweep.hpp"
#include "support/recordings.hpp"

namespace slipfit {
namespace {

constexpr double kRise = 0.3;       // A over F_s - F_k
constexpr double kLength_m = 2e-4;  // l

/// The scene with sticks that rise more steeply after each slip; F_s scatters by `jitter` of F_s - F_k.
Recording reloading_recording(const Scene& s, double rise_N) {
  std::mt19937_64 random(s.seed);
  std::normal_distribution<double> normal;
  const double unit_N = s.stiffness * s.speed / s.omega;
  const double lambda = (s.static_N - s.kinetic_N) / unit_N;
  const auto next_slip = [&] {
    return model::solve_slip(lambda * (1.0 + s.jitter * normal(random)) - 2.0 * s.zeta, s.zeta);
  };
  model::Slip slip = next_slip();
  const double step = slip.tau_end / s.samples_per_slip;
  double onset = lambda;
  std::vector<double> time_s, force;
  double before_N = s.kinetic_N;  // force at tau = 0 of the stick that goes on
  for (double cycles = 0.0; cycles < s.cycles; ++cycles) {
    model::Slip next = next_slip();
    const double end_z = model::stick_after(slip).intercept + slip.tau_end;
    const double drop_m = unit_N * (next.z0 - end_z) / s.stiffness;
    const double stick_m = model::reloaded_stick_m(drop_m, rise_N / s.stiffness, kLength_m);
    const double end = onset + slip.tau_end;
    const double next_onset = end + s.omega * stick_m / s.speed;
    for (double tau = step * static_cast<double>(time_s.size()); tau < next_onset;
         tau = step * static_cast<double>(time_s.size())) {
      time_s.push_back(tau / s.omega);
      double force_N = before_N + unit_N * tau;
      if (tau > onset) {
        force_N = s.kinetic_N + unit_N * model::slip_wave(slip, tau - onset).z;
      }
      if (tau > end) {
        const double x_m = s.speed * (tau - end) / s.omega;
        force_N = s.kinetic_N + unit_N * end_z + s.stiffness * x_m + rise_N * (1.0 - std::exp(-x_m / kLength_m));
      }
      force.push_back(force_N + s.noise * (s.static_N - s.kinetic_N) * normal(random));
    }
    onset = next_onset;
    slip = next;
  }
  Conditions conditions = s.conditions;
  conditions.speed_m_per_s = s.speed;
  conditions.zero_force_N = 0.0;
  return Recording::create(std::move(time_s), std::move(force), conditions).value();
}

Scene bent_sticks() {
  return {.cycles = 40.0, .jitter = 0.03, .noise = 0.005};
}

/// The same with forces to the nearest multiple of `step_N`.
Recording rounded(const Recording& exact, double step_N) {
  std::vector<double> force;
  for (const double force_N : exact.force()) force.push_back(step_N * std::round(force_N / step_N));
  return test::with_force(exact, std::move(force));
}

fit::RiseAfterSlip two_slips() {
  return {kLength_m, 1.0, true, 0.01, {1.0, 1.2}, {1.03, 1.23}};
}

}  // namespace

TEST_CASE("the stick that recovers a drop is shorter by the rise after the slip") {
  const double drop_m = GENERATE(1e-5, 3e-4, 2e-3);
  const double rise_m = GENERATE(1e-6, 1e-4, 1e-3);
  CAPTURE(drop_m, rise_m);
  const double x = model::reloaded_stick_m(drop_m, rise_m, kLength_m);
  CHECK(x + rise_m * (1.0 - std::exp(-x / kLength_m)) == Approx(drop_m).epsilon(1e-14));
  CHECK(model::reloaded_stick_m(drop_m, 0.0, kLength_m) == Approx(drop_m).epsilon(1e-15));
  using Jet = ceres::Jet<double, 3>;
  const Jet jet = model::reloaded_stick_m(Jet(drop_m, 0), Jet(rise_m, 1), Jet(kLength_m, 2));
  const auto slope = [](const auto& at, double h) { return (at(h) - at(-h)) / (2.0 * h); };
  const double h = 1e-5;
  const double by_drop =
      slope([&](double e) { return model::reloaded_stick_m(drop_m * (1.0 + e), rise_m, kLength_m); }, h) / drop_m;
  const double by_rise =
      slope([&](double e) { return model::reloaded_stick_m(drop_m, rise_m * (1.0 + e), kLength_m); }, h) / rise_m;
  const double by_length =
      slope([&](double e) { return model::reloaded_stick_m(drop_m, rise_m, kLength_m * (1.0 + e)); }, h) / kLength_m;
  CHECK(jet.v[0] == Approx(by_drop).epsilon(1e-7));
  CHECK(jet.v[1] == Approx(by_rise).epsilon(1e-7));
  CHECK(jet.v[2] == Approx(by_length).epsilon(1e-7).margin(1e-9));
}

TEST_CASE("the rise after a slip is averaged exactly and knows its derivatives") {
  const double average_s = GENERATE(0.0, 0.02, 0.1);
  const fit::RiseAfterSlip rise = two_slips();
  const auto instant = [&](double time_s) { return fit::RiseAroundSlip(rise, 1, kLength_m, 0.0).at(time_s).value; };
  for (const double time_s : {1.1, 1.17, 1.195, 1.21, 1.243, 1.25, 1.35}) {
    CAPTURE(average_s, time_s);
    const auto share = fit::RiseAroundSlip(rise, 1, kLength_m, average_s).at(time_s);
    const double h = 1e-5;
    const auto at = [&](double of_length, double of_average) {
      return fit::RiseAroundSlip(rise, 1, kLength_m * std::exp(of_length), average_s * std::exp(of_average))
          .at(time_s)
          .value;
    };
    CHECK(share.by_log_length == Approx((at(h, 0.0) - at(-h, 0.0)) / (2.0 * h)).margin(1e-8));
    if (average_s == 0.0) continue;
    CHECK(share.by_log_average == Approx((at(0.0, h) - at(0.0, -h)) / (2.0 * h)).margin(1e-8));
    // Midpoint rule, whose error over a kink is that of one step.
    constexpr int kSteps = 200000;
    double mean = 0.0;
    for (int i = 0; i < kSteps; ++i) mean += instant(time_s + average_s * ((i + 0.5) / kSteps - 0.5)) / kSteps;
    CHECK(share.value == Approx(mean).margin(1e-8));
  }
  // Before the onset the rise after the slip before it is nearly made, and 0 at the onset.
  CHECK(instant(1.2) == Approx(0.0).margin(1e-12));
  CHECK(instant(1.215) == 0.0);
  CHECK(instant(1.23 + 0.02) == Approx(1.0 - std::exp(-1.0)));
}

TEST_CASE("a rise after slips is found with the other parameters") {
  Scene s = bent_sticks();
  s.seed = GENERATE(range<std::uint64_t>(1, 5));
  CAPTURE(s.seed);
  const double difference_N = s.static_N - s.kinetic_N;
  const Analysis analysis = analyze_and_fit(reloading_recording(s, kRise * difference_N));
  REQUIRE(analysis.fit);
  for (const auto& [name, truth] :
       {std::pair{"reload_force_N", kRise * difference_N}, std::pair{"reload_length_m", kLength_m},
        std::pair{"stiffness_N_per_m", s.stiffness}, std::pair{"natural_frequency_rad_per_s", s.omega},
        std::pair{"damping_ratio", s.zeta}, std::pair{"friction_difference_N", difference_N}}) {
    INFO(name);
    const Estimate& estimate = parameter(analysis, name).estimate;
    REQUIRE(estimate.standard_error);
    CHECK(std::abs(*estimate.value - truth) < 3.5 * *estimate.standard_error);
    CHECK(*estimate.value == Approx(truth).epsilon(0.1));
  }
  CHECK(parameter(analysis, "stiffness_N_per_m").status == ParameterStatus::Identified);
  // The period that the model says is that of the recording.
  REQUIRE(analysis.derived.periodic_displacement_m.value);
  CHECK(*analysis.derived.periodic_displacement_m.value ==
        Approx(*analysis.derived.pattern_spacing_m.value).epsilon(0.02));
}

TEST_CASE("a sweep shares the length of the rise, and predicts with it a speed that was not measured") {
  Scene s = bent_sticks();
  const double rise_N = kRise * (s.static_N - s.kinetic_N);
  std::vector<SweepEntry> entries;
  for (const double speed : {0.005, 0.01, 0.02, 0.04}) {
    s.speed = speed;
    ++s.seed;
    entries.push_back({std::to_string(speed), reloading_recording(s, rise_N)});
  }
  const SweepAnalysis sweep = analyze_sweep(entries);
  REQUIRE(sweep.fit);
  const FitResult& fit = sweep.fit->result;
  const Estimate length = fit.estimate_of(ParameterId::ReloadLength);
  REQUIRE(length.value);
  CHECK(length.ci95->low < kLength_m);
  CHECK(length.ci95->high > kLength_m);
  CHECK(*length.value == Approx(kLength_m).epsilon(0.05));
  REQUIRE(fit.estimate);
  REQUIRE(fit.estimate->reloading);
  PredictionModel model;
  model.estimate = *fit.estimate;
  model.has_covariance = true;
  s.speed = 0.0025;
  const Recording unseen = reloading_recording(s, rise_N);
  const Analysis truth = analyze_and_fit(unseen);
  const std::vector<double> speeds{s.speed};
  const Estimate predicted = predict_at(model, speeds).rows.front().periodic_displacement_m;
  REQUIRE(predicted.value);
  // The mean of 40 cycles whose static friction scatters by 3 %
  CHECK(*predicted.value == Approx(s.speed / *truth.frequency.quoted.value).epsilon(0.02));
}

TEST_CASE("a rise that lasts few samples is found behind an average, whose time it does not spoil") {
  Scene s = bent_sticks();
  s.noise = 0.0;
  s.samples_per_slip = 36.0;
  s.cycles = 120.0;
  s.seed = GENERATE(range<std::uint64_t>(1, 5));
  CAPTURE(s.seed);
  const double difference_N = s.static_N - s.kinetic_N;
  constexpr std::size_t kAverage = 40;  // W = 3.5 / w_n
  constexpr std::size_t kEvery = 9;     // four samples in a slip
  const Recording fine =
      moving_average(reloading_recording(s, kRise * difference_N), kAverage, 0.003 * difference_N, s.seed);
  const double average_s = static_cast<double>(kAverage) * (fine.time_s()[1] - fine.time_s()[0]);
  const Analysis analysis = analyze_and_fit(test::thinned(fine, kEvery));
  REQUIRE(analysis.fit);
  for (const auto& [name, truth] :
       {std::pair{"sensor_average_s", average_s}, std::pair{"reload_force_N", kRise * difference_N},
        std::pair{"reload_length_m", kLength_m}, std::pair{"stiffness_N_per_m", s.stiffness}}) {
    INFO(name);
    const Estimate& estimate = parameter(analysis, name).estimate;
    CHECK(std::abs(*estimate.value - truth) < 3.5 * *estimate.standard_error);
  }
}

TEST_CASE("a sweep finds the length of the rise behind an average that nobody stated") {
  Scene s = bent_sticks();
  s.noise = 0.0;
  const double difference_N = s.static_N - s.kinetic_N;
  std::vector<SweepEntry> entries;
  for (const double speed : {0.005, 0.01, 0.02, 0.04}) {
    s.speed = speed;
    ++s.seed;
    const Recording exact = reloading_recording(s, kRise * difference_N);
    entries.push_back({std::to_string(speed), moving_average(exact, 9, 0.005 * difference_N, s.seed)});
  }
  const SweepAnalysis sweep = analyze_sweep(entries, {});
  REQUIRE(sweep.fit);
  const FitResult& fit = sweep.fit->result;
  REQUIRE(fit.estimate_of(ParameterId::SensorAverage).value);
  // By the length of the fits without an average l would be 7 % too large, and k 0.5 % too small.
  for (const auto& [id, truth] :
       {std::pair{ParameterId::ReloadLength, kLength_m}, std::pair{ParameterId::Stiffness, s.stiffness}}) {
    const Estimate estimate = fit.estimate_of(id);
    CAPTURE(*estimate.value, truth);
    REQUIRE(estimate.ci95);
    CHECK(estimate.ci95->low < truth);
    CHECK(estimate.ci95->high > truth);
  }
  CHECK(*fit.estimate_of(ParameterId::ReloadLength).value == Approx(kLength_m).epsilon(0.02));
  CHECK(*fit.stiffness().value == Approx(s.stiffness).epsilon(0.002));
}

TEST_CASE("the mass beside a rise includes the contact that relaxes with time") {
  Scene s = bent_sticks();
  const double rise_N = kRise * (s.static_N - s.kinetic_N);
  const Analysis analysis = analyze_and_fit(reloading_recording(s, rise_N));
  const Estimate& mass = parameter(analysis, "mass_kg").estimate;
  const double k = *parameter(analysis, "stiffness_N_per_m").estimate.value;
  const double omega = *parameter(analysis, "natural_frequency_rad_per_s").estimate.value;
  const double path_m = s.speed * *analysis.cycles.stick_time_s;
  const double secant = k + rise_N * (1.0 - std::exp(-path_m / kLength_m)) / path_m;
  CHECK(mass.ci95->low < k / (omega * omega));
  CHECK(mass.ci95->high > secant / (omega * omega));
  CHECK(*mass.value > 1.01 * k / (omega * omega));
  CHECK(parameter(analysis, "mass_kg").status == ParameterStatus::Weak);
}

TEST_CASE("rounding makes no rise and hides none that is larger than its steps") {
  Scene s = bent_sticks();
  s.seed = GENERATE(range<std::uint64_t>(1, 5));
  s.cycles = 300.0;
  s.jitter = 0.05;
  CAPTURE(s.seed);
  const double difference_N = s.static_N - s.kinetic_N;
  const Analysis straight = analyze_and_fit(rounded(reloading_recording(s, 0.0), 0.2 * difference_N));
  REQUIRE(straight.fit);
  CHECK(straight.fit->find(ParameterId::ReloadLength) == nullptr);
  const Analysis rising = analyze_and_fit(rounded(reloading_recording(s, kRise * difference_N), 0.1 * difference_N));
  REQUIRE(rising.fit);
  CHECK(rising.fit->find(ParameterId::ReloadLength) != nullptr);
}

}  // namespace slipfit
