#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "fit/scene.hpp"
#include "support/recordings.hpp"

namespace slipfit {
namespace {

Recording sine(double fifth_harmonic, double noise_rms = 0.0) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise;
  std::vector<double> time_s, force;
  for (int i = 0; i < 20000; ++i) {
    time_s.push_back(1e-3 * i);
    const double phase = 2.0 * std::numbers::pi * 2.5 * time_s.back();
    force.push_back(3.0 + std::sin(phase) + fifth_harmonic * std::sin(5.0 * phase) + noise_rms * noise(random));
  }
  return test::recording_of(std::move(time_s), std::move(force), 0.01);
}

}  // namespace

TEST_CASE("a wave that three sines follow has no sticks to fit") {
  CHECK_FALSE(analyze_and_fit(sine(0.0)).fit);
  CHECK(analyze_and_fit(sine(0.0)).motion != MotionClass::StickSlip);
  CHECK(analyze_and_fit(sine(1e-3)).fit);
}

TEST_CASE("a wave beneath noise is fitted: the fit tells slips that the noise hides from sines") {
  CHECK(analyze_and_fit(sine(0.0, 0.05)).fit);
  CHECK(analyze_and_fit(sine(0.02, 0.05)).fit);
}

TEST_CASE("sticks of a twentieth of the cycle are fitted, however round the trace is") {
  const Analysis analysis = analyze_and_fit(record({.zeta = 0.001, .speed = 0.48}));
  REQUIRE(analysis.fit);
  CHECK(analysis.motion == MotionClass::StickSlip);
}

}  // namespace slipfit
