// Which method the quoted frequency comes from, and that its interval holds the truth either way.

#include <catch2/catch.hpp>

#include "slipfit/model/simulation.hpp"
#include "slipfit/pipeline.hpp"
#include "support/holds.hpp"
#include "support/recordings.hpp"

using namespace slipfit;

namespace {

struct SawTooth {
  Analysis analysis;
  double frequency_Hz = 0.0;  ///< of the mean static friction
};

SawTooth scene(std::uint64_t seed, double static_friction_sd_N) {
  constexpr double kSpeed_m_per_s = 0.015;
  const Slider slider = Slider::create(500.0, 120.0, 0.05).value();
  const Friction friction = Friction::create(2.0, 1.4).value();
  const LimitCycle cycle = *damped_motion(slider, friction, kSpeed_m_per_s).cycle;
  const SimulationOptions options{.duration_s = 60.0 * cycle.period_s,
                                  .sample_rate_Hz = 30.0 / cycle.slip_s,
                                  .static_friction_sd_N = static_friction_sd_N,
                                  .noise_rms_N = 0.01,
                                  .seed = seed};
  SimulatedTrace trace = simulate(slider, friction, kSpeed_m_per_s, options);
  return {analyze_and_fit(test::recording_of(std::move(trace.time_s), std::move(trace.force_N), kSpeed_m_per_s)),
          1.0 / cycle.period_s};
}

}  // namespace

TEST_CASE("regular cycles are timed by all samples, scattering ones by their drops") {
  int from_spectrum = 0, held = 0, scattered_held = 0;
  constexpr std::uint64_t kRecordings = 30;
  for (std::uint64_t seed = 1; seed <= kRecordings; ++seed) {
    const SawTooth regular = scene(seed, 0.0);
    const Estimate& quoted = regular.analysis.frequency.quoted;
    REQUIRE(quoted.ci95);
    if (test::holds(quoted, regular.frequency_Hz)) ++held;
    if (regular.analysis.frequency.method == FrequencyMethod::HarmonicLeastSquares) {
      ++from_spectrum;
      CHECK(*quoted.standard_error < 3e-5 * regular.frequency_Hz);  // the bound is 4e-6, the mean period has 2e-4
    }
    const SawTooth scattered = scene(seed, 0.03);
    INFO("seed " << seed);
    CHECK(scattered.analysis.frequency.method == FrequencyMethod::FittedCycles);
    const Estimate& mean = scattered.analysis.frequency.quoted;
    REQUIRE(mean.ci95);
    if (test::holds(mean, scattered.frequency_Hz)) ++scattered_held;
  }
  CHECK(from_spectrum >= 20);
  // Of 30 intervals of 95 % fewer than 26 hold the truth once in 60 times.
  CHECK(held >= 26);
  CHECK(scattered_held >= 26);
}
