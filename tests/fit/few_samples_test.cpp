#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <utility>

#include "families.hpp"
#include "scene.hpp"

using namespace slipfit;

namespace {

Scene few_samples(std::uint64_t seed) {
  return {.zeta = 0.1, .speed = 0.003, .cycles = 40.0, .samples_per_slip = 2.6, .noise = 0.01, .seed = seed};
}

/// Every sample the mean over its step of the clock, as many loggers have it.
Recording averaged_over_step(Scene scene) {
  constexpr std::size_t kFiner = 16;
  scene.samples_per_slip *= static_cast<double>(kFiner);
  const double noise_N = std::exchange(scene.noise, 0.0) * (scene.static_N - scene.kinetic_N);
  return test::thinned(moving_average(record(scene), kFiner, noise_N, scene.seed), kFiner);
}

}  // namespace

TEST_CASE(
    "slips of one to two samples that are averaged over a step: the intervals of k and w_n hold and k's is narrow") {
  int given = 0;
  int inside = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Scene scene = few_samples(seed);
    scene.jitter = 0.05;
    scene.samples_per_slip = 1.0 + 0.04 * static_cast<double>(seed);
    const Analysis analysis = analyze_and_fit(averaged_over_step(scene));
    const Interval k = *parameter(analysis, "stiffness_N_per_m").estimate.ci95;
    CHECK(k.high - k.low < 0.01 * scene.stiffness);  // once 0.03: a linear extrapolation of what averaging does
    const auto w_n = parameter(analysis, "natural_frequency_rad_per_s").estimate.ci95;
    given += w_n ? 2 : 1;
    inside += k.low <= scene.stiffness && scene.stiffness <= k.high ? 1 : 0;
    inside += w_n && w_n->low <= scene.omega && scene.omega <= w_n->high ? 1 : 0;
  }
  INFO(inside << " of " << given);
  CHECK(given > 25);
  CHECK(inside >= 0.87 * given);  // 95 % expected; w_n once held in 1 of 10
}

TEST_CASE("intervals of few samples per slip hold zeta, F_s - F_k and w_n") {
  int given = 0;
  int inside = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Scene s = few_samples(seed);
    const Analysis analysis = analyze_and_fit(record(s));
    const std::pair<const char*, double> truths[] = {{"natural_frequency_rad_per_s", s.omega},
                                                     {"friction_difference_N", s.static_N - s.kinetic_N},
                                                     {"damping_ratio", s.zeta}};
    for (const auto& [name, truth] : truths) {
      const auto ci = parameter(analysis, name).estimate.ci95;
      if (!ci) continue;
      ++given;
      inside += ci->low <= truth && truth <= ci->high ? 1 : 0;
    }
  }
  INFO(inside << " of " << given);
  CHECK(given > 100);
  CHECK(inside >= 0.87 * given);  // 95 % expected; three of a recording miss together
}

TEST_CASE("a fit with zeta = 0 does not stop at a false minimum") {
  // Few samples a slip, the free zeta far below 0 by chance: k was off by 10 to 60 % and called identified.
  const std::uint64_t index = GENERATE(1138U, 1576U, 446U, 1870U);
  const coverage::Scene scene = coverage::make_scene("sparse", index, 777);
  const Analysis analysis = analyze_and_fit(scene.recording);
  REQUIRE(analysis.fit);
  const Estimate& k = parameter(analysis, "stiffness_N_per_m").estimate;
  CHECK(std::abs(*k.value - scene.truth.stiffness_N_per_m) < 5.0 * *k.standard_error);
}
