#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "analysis/checks.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/pipeline.hpp"
#include "support/recordings.hpp"

namespace slipfit {
namespace {

struct Run {
  double speed_m_per_s = 0.001;
  double stiffness_N_per_m = 8000.0;  // of the loading ramp and the sticks
  double ring_Hz = 40.0;
  double ring_ratio = 0.05;
  double noise_N = 0.004;
  double slip_s = 0.004;  // half a period of the slips
  std::size_t repeats = 1;
};

constexpr double kBumpRate_Hz = 4000.0;
constexpr double kBreakaway_N = 2.4;
constexpr double kBumpDrop_N = 0.6;

/// 0.5 s of rest, a loading ramp, slips of half a cosine from 2.0 N, release to rest at 6 s with a free ring-down.
Recording run_with_release(const Run& run) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, run.noise_N);
  std::vector<double> time_s, force;
  double load = 0.0, slip_from = 0.0, since_slip_s = 1.0;
  bool first = true;
  for (std::size_t i = 0; i < static_cast<std::size_t>(7.0 * kBumpRate_Hz); ++i) {
    const double t = static_cast<double>(i) / kBumpRate_Hz;
    const double dt = 1.0 / kBumpRate_Hz;
    if (t > 0.5 && t < 6.0) {
      since_slip_s += dt;
      if (since_slip_s < run.slip_s) {
        load = slip_from - 0.5 * kBumpDrop_N * (1.0 - std::cos(std::numbers::pi * since_slip_s / run.slip_s));
      } else {
        load += run.stiffness_N_per_m * run.speed_m_per_s * dt;
      }
      if (since_slip_s >= run.slip_s && load > (first ? kBreakaway_N : 2.0)) {
        slip_from = load;
        since_slip_s = 0.0;
        first = false;
      }
    }
    double shown = load;
    if (t >= 6.0) {
      const double phase = 2.0 * std::numbers::pi * run.ring_Hz * (t - 6.0);
      shown = 1.6 * std::exp(-run.ring_ratio * phase) * std::cos(phase);
    }
    time_s.push_back(t);
    const bool repeats = i % run.repeats != 0 && !force.empty();
    force.push_back(repeats ? force.back() : shown + noise(random));
  }
  return test::recording_of(std::move(time_s), std::move(force), run.speed_m_per_s);
}

}  // namespace

TEST_CASE("loading ramp, breakaway and ring-down are measured outside the sliding", "[transients]") {
  const Run run;
  const Analysis analysis = analyze(run_with_release(run));
  REQUIRE(analysis.motion == MotionClass::StickSlip);
  CHECK(*analysis.cycles.stick_stiffness.value == Approx(run.stiffness_N_per_m).epsilon(0.01));
  CHECK(warns(analysis, "part_of_recording"));  // it slides for 5.2 of 7 s
  const Transients& found = analysis.transients;
  REQUIRE(found.loading_stiffness_N_per_m.value);
  CHECK(*found.loading_stiffness_N_per_m.value == Approx(run.stiffness_N_per_m).epsilon(0.02));
  CHECK(holds(found.loading_stiffness_N_per_m, run.stiffness_N_per_m));
  REQUIRE(found.breakaway_force.value);
  CHECK(*found.breakaway_force.value == Approx(kBreakaway_N).epsilon(0.01));
  REQUIRE(found.ring_down_frequency_Hz.value);
  CHECK(*found.ring_down_frequency_Hz.value == Approx(run.ring_Hz).epsilon(0.03));
  CHECK(holds(found.ring_down_frequency_Hz, run.ring_Hz));
  CHECK(*found.ring_down_damping_ratio.value == Approx(run.ring_ratio).epsilon(0.2));
  CHECK(holds(found.ring_down_damping_ratio, run.ring_ratio));
}

TEST_CASE("a small peak on the loading ramp is not the breakaway", "[transients]") {
  std::mt19937_64 random(4);
  std::normal_distribution<double> noise(0.0, 0.002);
  std::vector<double> time_s, force;
  for (int i = 0; i < 5000; ++i) {
    const double t = 1e-3 * i;
    const double slack = t < 0.5 ? 0.25 * std::sin(std::numbers::pi * t / 0.5) : 0.0;  // a line that tightens
    const double load = t < 0.5 ? 0.0 : std::min(1.0, 2.0 * (t - 0.5));
    const double peak = 0.2 * std::exp(-std::pow((t - 1.0) / 0.05, 2)) - 0.2 * std::exp(-std::pow((t - 1.2) / 0.05, 2));
    time_s.push_back(t);
    force.push_back(slack + load + peak + noise(random));
  }
  const Analysis analysis = analyze(test::recording_of(time_s, force, 0.001));
  REQUIRE(analysis.transients.breakaway_force.value);
  CHECK(*analysis.transients.breakaway_force.value == Approx(1.2).epsilon(0.05));
}

TEST_CASE("a recording without run-up and release has no transients", "[transients]") {
  const Recording whole = run_with_release({});
  const Analysis analysis = analyze(whole.part(6000, 22000));
  REQUIRE(analysis.motion == MotionClass::StickSlip);
  CHECK_FALSE(warns(analysis, "part_of_recording"));
  CHECK_FALSE(analysis.transients.loading_stiffness_N_per_m.value);
  CHECK_FALSE(analysis.transients.ring_down_frequency_Hz.value);
  CHECK_FALSE(analysis.transients.loading_stiffness_N_per_m.note.empty());
}

TEST_CASE("noise alone has no transients", "[transients]") {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(1.0, 0.01);
  std::vector<double> time_s, force;
  for (int i = 0; i < 20000; ++i) {
    time_s.push_back(i / kBumpRate_Hz);
    force.push_back(noise(random));
  }
  const Analysis analysis = analyze(test::recording_of(time_s, force, 0.001));
  CHECK_FALSE(analysis.transients.breakaway_force.value);
  CHECK_FALSE(analysis.transients.ring_down_frequency_Hz.value);
}

TEST_CASE("slips far slower than the ring-down of the rig do not identify the natural frequency", "[transients]") {
  Run run;
  run.ring_Hz = 400.0;
  run.slip_s = 0.02;  // 25 Hz
  const Analysis analysis = analyze_and_fit(run_with_release(run));
  REQUIRE(analysis.motion == MotionClass::StickSlip);
  REQUIRE(analysis.fit);
  CHECK(warns(analysis, "slips_not_inertial"));
  for (const ParameterId id : {ParameterId::NaturalFrequency, ParameterId::Mass}) {
    REQUIRE(analysis.fit->find(id) != nullptr);
    CHECK(analysis.fit->find(id)->status != ParameterStatus::Identified);
  }
  CHECK(analysis.fit->stiffness().value);
}

TEST_CASE("values that a logger repeats are used once", "[repeats]") {
  Run run;
  run.repeats = 4;
  const Analysis repeated = analyze_and_fit(run_with_release(run));
  CHECK(warns(repeated, "repeated_values"));
  run.repeats = 1;
  const Analysis plain = analyze_and_fit(run_with_release(run));
  CHECK_FALSE(warns(plain, "repeated_values"));
  REQUIRE(repeated.frequency.quoted.value);
  CHECK(*repeated.frequency.quoted.value == Approx(*plain.frequency.quoted.value).epsilon(0.002));
}

TEST_CASE("slips in time with the stated drive are clocked", "[regularity]") {
  const Recording free = run_with_release({});
  const Analysis own = analyze(free);
  REQUIRE(own.cycles.regularity == Regularity::Regular);
  const auto with_drive = [&](double period_s) {
    Conditions conditions = free.conditions();
    conditions.drive_period_s = period_s;
    return analyze(test::with_conditions(free, conditions));
  };
  const double period_s = 1.0 / *own.frequency.quoted.value;
  CHECK(with_drive(period_s).cycles.regularity == Regularity::Clocked);
  CHECK(with_drive(period_s / 2.0).cycles.regularity == Regularity::Clocked);
  CHECK(with_drive(2.0 * period_s).cycles.regularity == Regularity::Clocked);
  CHECK(with_drive(1.03 * period_s).cycles.regularity == Regularity::Regular);
  CHECK(warns(with_drive(period_s), "clocked"));
}

}  // namespace slipfit
