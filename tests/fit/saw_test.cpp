// Straight sticks and falls along half a cosine whose troughs all lie on one level while the peaks scatter: slips
// without damping at levels that wander, or slips with much damping at one level, as far as the peaks tell.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "fit/scene.hpp"
#include "support/recordings.hpp"

namespace slipfit {
namespace {

constexpr double kNoise = 0.01;  // of the drop, which is 1 N

struct Saw {
  std::vector<double> time_s, force;
};

/// 10 kHz, 402 samples a cycle, 36 a fall.
Saw saw(std::size_t cycles, std::uint64_t seed, double hum_N = 0.0) {
  constexpr int kFall = 36;
  constexpr double kStick = 366.0;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Saw made;
  const auto add = [&](double force) {
    made.time_s.push_back(1e-4 * static_cast<double>(made.time_s.size()));
    const double hum = hum_N * std::sin(2.0 * std::numbers::pi * 50.0 * made.time_s.back());
    made.force.push_back(3.0 + force + hum + kNoise * normal(random));
  };
  for (std::size_t cycle = 0; cycle < cycles; ++cycle) {
    const double drop = std::max(0.1, 1.0 + 0.05 * normal(random));
    const double stick = std::round(drop * kStick);
    for (double i = 0.0; i < stick; ++i) add(drop * i / stick);
    for (int i = 1; i <= kFall; ++i) add(drop * 0.5 * (1.0 + std::cos(std::numbers::pi * i / kFall)));
  }
  return made;
}

Analysis fitted(Saw made) {
  return analyze_and_fit(test::recording_of(std::move(made.time_s), std::move(made.force), 0.01));
}

void check_half_of_drop(const Analysis& analysis) {
  REQUIRE(analysis.fit);
  const Parameter& difference = parameter(analysis, "friction_difference_N");
  REQUIRE(difference.estimate.value);
  REQUIRE(analysis.cycles.force_drop);
  CHECK(*difference.estimate.value ==
        Approx(0.5 * *analysis.cycles.force_drop).epsilon(0.1));  // nearly all of the drop with much damping
}

}  // namespace

TEST_CASE("rounding to a tenth of the drop makes neither damping nor a rise after slips") {
  const auto seed = GENERATE(range<std::uint64_t>(1, 7));
  CAPTURE(seed);
  Saw made = saw(300, seed);
  for (double& force : made.force) force = 0.1 * std::round(force / 0.1);
  const Analysis analysis = fitted(std::move(made));
  check_half_of_drop(analysis);
  CHECK(analysis.fit->find(ParameterId::ReloadLength) == nullptr);
}

TEST_CASE("impulses on every tenth sample make neither damping nor a line left in the sticks") {
  Saw made = saw(250, 7);
  for (std::size_t i = 0; i < made.force.size(); i += 10) made.force[i] += 20.0;
  const Analysis analysis = fitted(std::move(made));
  check_half_of_drop(analysis);
  CHECK_FALSE(has_warning(analysis, "suspicious_line"));
}

TEST_CASE("hum that is fitted widens no interval and bends no stick") {
  const Analysis quiet = fitted(saw(250, 7));
  const Analysis humming = fitted(saw(250, 7, 0.3));
  check_half_of_drop(humming);
  CHECK(has_warning(humming, "hum_fitted"));
  CHECK(humming.fit->residual.rms == Approx(kNoise).epsilon(0.02));
  CHECK(*parameter(humming, "stiffness_N_per_m").estimate.standard_error <
        2.0 * *parameter(quiet, "stiffness_N_per_m").estimate.standard_error);
}

}  // namespace slipfit
