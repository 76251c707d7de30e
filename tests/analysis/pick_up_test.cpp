#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/pipeline.hpp"
#include "support/recordings.hpp"

namespace slipfit {
namespace {

constexpr double kSampleRate_Hz = 500.0;
constexpr double kLine_Hz = 7.3;

struct Wave {
  double swing_N = 0.4;         ///< peak to peak
  double phase_walk_rad = 0.0;  ///< standard deviation of the phase's step from period to period
  double noise_N = 0.01;
  unsigned seed = 1;
};

/// 12 s of a wave on a steady force of 2 N.
Recording wave(const Wave& w) {
  std::mt19937_64 random(w.seed);
  std::normal_distribution<double> normal;
  std::vector<double> time_s, force;
  double phase = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(12.0 * kSampleRate_Hz); ++i) {
    time_s.push_back(static_cast<double>(i) / kSampleRate_Hz);
    phase += 2.0 * std::numbers::pi * kLine_Hz / kSampleRate_Hz +
             w.phase_walk_rad * std::sqrt(kLine_Hz / kSampleRate_Hz) * normal(random);
    force.push_back(2.0 + 0.5 * w.swing_N * std::sin(phase) + w.noise_N * normal(random));
  }
  return test::recording_of(std::move(time_s), std::move(force), 1e-3);
}

/// Rest, a loading ramp of 1 s, sliding at 2 N until 11 s, release with a ring-down; the wave in all of it. `zero_N`:
/// what the sensor shows at rest.
Recording steady_run(double swing_N, double zero_N) {
  const Recording steady = wave({.swing_N = swing_N});
  std::vector<double> force;
  for (std::size_t i = 0; i < steady.size(); ++i) {
    const double t = steady.time_s()[i];
    const double sliding = std::clamp(2.0 * (t - 0.5), 0.0, 2.0);
    const double released = std::exp(-4.0 * (t - 11.0)) * std::cos(60.0 * (t - 11.0));
    force.push_back(steady.force()[i] - 2.0 + zero_N + (t < 11.0 ? sliding : released));
  }
  return test::with_force(steady, std::move(force));
}

}  // namespace

TEST_CASE("a wave that keeps time like a clock is not quoted as slip, one whose periods scatter is") {
  const Analysis clock = analyze_and_fit(wave({}));
  CHECK(clock.motion == MotionClass::Undetermined);
  CHECK_FALSE(clock.frequency.quoted.value);
  CHECK_FALSE(clock.derived.pattern_spacing_m.value);
  REQUIRE_FALSE(clock.frequency.lines.empty());
  CHECK(clock.frequency.lines.front().frequency_Hz == Approx(kLine_Hz).epsilon(1e-3));

  const Analysis motion = analyze_and_fit(wave({.phase_walk_rad = 0.4}));
  CHECK(motion.motion == MotionClass::OscillatorySlip);
  CHECK(*motion.frequency.quoted.value == Approx(kLine_Hz).epsilon(0.05));
}

TEST_CASE("no parameter of a sine is identified, whatever its noise") {
  const unsigned seed = GENERATE(range(1U, 25U));
  const double noise_N = GENERATE(0.002, 0.01, 0.03);
  const Analysis analysis = analyze_and_fit(wave({.noise_N = noise_N, .seed = seed}));
  if (!analysis.fit) return;
  for (const Parameter& parameter : analysis.fit->parameters) {
    CHECK(parameter.status != ParameterStatus::Identified);
  }
}

TEST_CASE("a steady run with pick-up slides between loading ramp and release") {
  const double zero_N = GENERATE(0.0, 3.0);
  const Recording run = steady_run(0.06, zero_N);
  const Analysis analysis = analyze_and_fit(run);
  CHECK(analysis.motion == MotionClass::SteadySliding);
  CHECK_FALSE(analysis.frequency.quoted.value);
  CHECK(analysis.sliding.begin_s == Approx(1.5).margin(0.2));
  CHECK(analysis.sliding.end_s == Approx(11.0).margin(0.2));
}

TEST_CASE("two levels of sliding are no rest and sliding") {
  const Recording steady = wave({.swing_N = 0.06});
  std::vector<double> force(steady.force().begin(), steady.force().end());
  for (std::size_t i = force.size() / 2; i < force.size(); ++i) force[i] += 1.0;
  const Recording stepped = test::with_force(steady, std::move(force));
  const Analysis analysis = analyze_and_fit(stepped);
  CHECK(analysis.sliding.begin_s == stepped.time_s().front());
  CHECK(analysis.sliding.end_s == stepped.time_s().back());
}

}  // namespace slipfit
