#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <utility>

#include "fit/scene.hpp"

namespace slipfit {
namespace {

/// Printed plastic as in the issue of slow testers: k = 350 N/m, 232 g, zeta = 0.15, F_s - F_k = 200 mN.
Scene printed_plastic() {
  return {.stiffness = 350.0,
          .omega = std::sqrt(350.0 / 0.232),
          .zeta = 0.15,
          .static_N = 1.2,
          .kinetic_N = 1.0,
          .speed = 1e-3,
          .cycles = 40.0,
          .samples_per_slip = 50.0,
          .jitter = 0.02};
}

/// With noise of a hundredth of the friction difference.
Recording averaged(const Scene& s, std::size_t samples) {
  return moving_average(record(s), samples, 0.002, 7);
}

}  // namespace

TEST_CASE("slips seen through an average that nobody stated: its time and the mass are found") {
  const std::size_t samples = GENERATE(15U, 31U, 61U);
  CAPTURE(samples);
  const Scene s = printed_plastic();
  const Recording recording = averaged(s, samples);
  const Analysis analysis = analyze_and_fit(recording);
  REQUIRE(analysis.fit);
  const Parameter& average = parameter(analysis, "sensor_average_s");
  REQUIRE(average.estimate.ci95);
  const double true_average_s = static_cast<double>(samples) * recording.sample_interval_s();
  CHECK(average.estimate.ci95->low <= true_average_s);
  CHECK(average.estimate.ci95->high >= true_average_s);
  for (const auto& [name, truth] : {std::pair{"mass_kg", 0.232}, std::pair{"stiffness_N_per_m", 350.0},
                                    std::pair{"damping_ratio", 0.15}, std::pair{"friction_difference_N", 0.2}}) {
    INFO(name);
    const Estimate& estimate = parameter(analysis, name).estimate;
    // Behind the longest average friction that weakens is not ruled out, and F_s - F_k is told by its bounds alone.
    if (samples == 61 && parameter(analysis, name).status == ParameterStatus::Bounded) {
      REQUIRE(estimate.ci95);
      CHECK(estimate.ci95->low <= truth);
      CHECK(estimate.ci95->high >= truth);
      continue;
    }
    REQUIRE(estimate.standard_error);
    // Twelve numbers: one in twenty lies outside its interval, one in four hundred outside three standard errors.
    CHECK(std::abs(*estimate.value - truth) < 3.0 * *estimate.standard_error);
    CHECK(*estimate.value == Approx(truth).epsilon(0.1));
  }
  CHECK(has_warning(analysis, "samples_averaged"));
}

TEST_CASE("slips that the clock does not resolve lend no time to an average") {
  Scene s = printed_plastic();
  s.zeta = 0.04;
  s.seed = GENERATE(range<std::uint64_t>(1, 13));
  const std::size_t every = GENERATE(21U, 23U, 25U);  // 2.0 to 2.4 samples a slip
  CAPTURE(s.seed, every);
  constexpr std::size_t kAveraged = 14;  // of 50 samples a slip
  const Recording all = averaged(s, kAveraged);
  const Analysis analysis = analyze_and_fit(test::thinned(all, every));
  REQUIRE(analysis.fit);
  for (const Parameter& p : analysis.fit->parameters) {
    if (p.name() != "sensor_average_s" || !p.estimate.ci95) continue;
    CHECK(p.estimate.ci95->low <= static_cast<double>(kAveraged) * all.sample_interval_s());
  }
}

TEST_CASE("samples of an instant get no average") {
  Scene s = printed_plastic();
  s.noise = 0.01;
  s.seed = GENERATE(range<std::uint64_t>(1, 13));
  const Analysis analysis = analyze_and_fit(record(s));
  for (const Parameter& p : analysis.fit->parameters) CHECK(p.name() != "sensor_average_s");
}

TEST_CASE("a stated mass gives the natural frequency where averaging hides it, and is held against it elsewhere") {
  Scene s = printed_plastic();
  s.conditions.mass_kg = 0.232;
  s.conditions.mass_standard_error_kg = 0.01 * 0.232;
  SECTION("averages longer than the slips") {
    const Analysis analysis = analyze_and_fit(averaged(s, 61));
    REQUIRE(analysis.fit);
    CHECK(analysis.fit->mass_gives_frequency);
    const Parameter& omega = parameter(analysis, "natural_frequency_rad_per_s");
    CHECK(omega.status == ParameterStatus::Conditional);
    CHECK(*omega.estimate.value == Approx(s.omega).epsilon(0.02));
    // d ln w_n = (d ln k - d ln m) / 2, and k is known far better than the mass.
    CHECK(*omega.estimate.standard_error == Approx(0.005 * s.omega).epsilon(0.1));
    const Estimate& mass = parameter(analysis, "mass_kg").estimate;
    CHECK(*mass.value == Approx(0.232).epsilon(0.005));
    CHECK(*mass.standard_error == Approx(0.00232).epsilon(0.03));
    const Estimate& zeta = parameter(analysis, "damping_ratio").estimate;
    REQUIRE(zeta.ci95);
    CHECK(zeta.ci95->low < s.zeta);
    CHECK(zeta.ci95->high > s.zeta);
  }
  SECTION("short averages") {
    const Analysis analysis = analyze_and_fit(averaged(s, 15));
    REQUIRE(analysis.fit);
    CHECK_FALSE(analysis.fit->mass_gives_frequency);
    CHECK(parameter(analysis, "natural_frequency_rad_per_s").status != ParameterStatus::Conditional);
  }
  SECTION("a mass that is not that of the slips") {
    s.conditions.mass_kg = 2.0;
    const Analysis analysis = analyze_and_fit(averaged(s, 61));
    REQUIRE(analysis.fit);
    CHECK_FALSE(analysis.fit->mass_gives_frequency);
  }
}

}  // namespace slipfit
