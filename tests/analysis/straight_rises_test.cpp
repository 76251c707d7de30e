// Straight sticks against round rises, slip by slip.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "slipfit/pipeline.hpp"
#include "support/recordings.hpp"

namespace slipfit {
namespace {

/// Forty rises of random heights and durations, each followed by a fall a fifth as long; `shape` is the force over
/// time, both from 0 to 1.
template <class Shape>
Recording rises(const Shape& shape, double scatter, double top) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<double> force;
  for (int i = 0; i < 40; ++i) {
    const double height = std::exp(scatter * normal(random));
    const auto samples = static_cast<int>(50.0 * std::exp(scatter * normal(random)));
    for (int j = 0; j < samples; ++j) force.push_back(height * shape(static_cast<double>(j) / samples));
    for (int j = 0; j < samples / 5; ++j) force.push_back(height * shape(1.0 - 5.0 * j / samples));
  }
  std::vector<double> time_s;
  for (double& f : force) {
    f = std::min(3.0 + f + 0.01 * normal(random), top);
    time_s.push_back(1e-3 * static_cast<double>(time_s.size()));
  }
  return test::recording_of(std::move(time_s), std::move(force), 1e-3);
}

constexpr double kOpen = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("ridges of a surface are no stick-slip, and irregular ones have no frequency") {
  const auto round = [](double x) { return 0.5 - 0.5 * std::cos(std::numbers::pi * x); };
  for (const Analysis& analysis : {analyze_and_fit(rises(round, 0.05, kOpen)), analyze(rises(round, 0.05, kOpen))}) {
    CHECK(analysis.motion == MotionClass::OscillatorySlip);
    CHECK(analysis.motion_reason.find("round") != std::string::npos);
  }
  for (const Analysis& analysis : {analyze_and_fit(rises(round, 0.5, kOpen)), analyze(rises(round, 0.5, kOpen))}) {
    CHECK(analysis.motion == MotionClass::Undetermined);
    CHECK(analysis.motion_reason.find("round") != std::string::npos);
    CHECK_FALSE(analysis.frequency.quoted.value);
  }
}

TEST_CASE("straight rises of mixed sizes are stick-slip, also with clipped tops") {
  const auto straight = [](double x) { return x; };
  for (const double top : {kOpen, 3.7}) {
    CAPTURE(top);
    CHECK(analyze_and_fit(rises(straight, 0.3, top)).motion == MotionClass::StickSlip);
    CHECK(analyze(rises(straight, 0.3, top)).motion == MotionClass::StickSlip);
  }
}

TEST_CASE("an oscillation whose frequency changes has no one frequency") {
  std::vector<double> time_s, force;
  for (int i = 0; i < 6000; ++i) {
    const double x = i / 6000.0;
    time_s.push_back(1e-3 * i);
    force.push_back(3.0 + std::sin(2.0 * std::numbers::pi * (20.0 * x + 20.0 * x * x)) + 1e-3 * std::sin(1e3 * x * x));
  }
  const Analysis analysis = analyze_and_fit(test::recording_of(std::move(time_s), std::move(force), 1e-3));
  CHECK(analysis.motion != MotionClass::StickSlip);
  CHECK_FALSE(analysis.frequency.quoted.value);
}

TEST_CASE("waves with noise have no sticks, whether their frequency stays or changes") {
  // Turns of the wave in 4000 samples, and how many times its frequency grows. Of 150 sines 6 had a stiffness, of 70
  // waves whose frequency changes 19.
  for (const double ratio : {1.000001, 1.6, 3.0}) {
    for (const double turns : {17.3, 24.6, 38.1, 52.7}) {
      std::mt19937_64 random(41);
      std::normal_distribution<double> normal;
      std::vector<double> time_s, force;
      for (int i = 0; i < 4000; ++i) {
        const double phase = turns * (std::pow(ratio, i / 4000.0) - 1.0) / (ratio - 1.0);
        time_s.push_back(1e-3 * i);
        force.push_back(3.0 + std::sin(2.0 * std::numbers::pi * phase) + 0.005 * normal(random));
      }
      CAPTURE(ratio, turns);
      const Analysis analysis = analyze_and_fit(test::recording_of(std::move(time_s), std::move(force), 1e-3));
      CHECK(analysis.motion != MotionClass::StickSlip);
    }
  }
}

}  // namespace slipfit
