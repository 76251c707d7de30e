// The regions of docs/accuracy/failures_fit_start.svg, failures_fit_sampling.svg, failures_fit_scatter.svg,
// failures_fit_hum.svg, failures_fit_average.svg and failures_fit_weakening.svg.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "scoring.hpp"
#include "slipfit/model/simulation.hpp"
#include "support/recordings.hpp"

namespace {

constexpr std::uint64_t kSeeds = 6;

template <class Check>
void for_each_fit(const atlas::Factors& factors, const Check& check, std::uint64_t seeds = kSeeds) {
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const atlas::Scene scene = atlas::make_scene(factors, seed);
    const slipfit::Analysis analysis = slipfit::analyze_and_fit(scene.recording);
    INFO("seed " << seed << " noise " << factors.noise << " hum " << factors.hum << " jitter " << factors.jitter
                 << " samples per slip " << factors.samples_per_slip << " cycles " << factors.cycles << ": "
                 << analysis.motion_reason);
    check(analysis, scene);
  }
}

/// Slips may be counted beneath the noise, but then rightly; what they are made of is not told.
void check_nothing_claimed(const slipfit::Analysis& analysis, const atlas::Scene& scene) {
  CHECK_FALSE(failures::frequency_is_wrong(analysis, scene));
  CHECK_FALSE(failures::any_parameter(analysis));
}

void check_not_confidently_wrong(const slipfit::Analysis& analysis, const atlas::Scene& scene) {
  CHECK_FALSE(failures::any_confidently_wrong(analysis, scene));
}

}  // namespace

TEST_CASE("false minimum: long regular recordings are fitted from slipfit's own start") {
  for (const double cycles : {40.0, 200.0}) {
    atlas::Factors factors;
    factors.cycles = cycles;
    for_each_fit(factors, [](const slipfit::Analysis& analysis, const atlas::Scene& scene) {
      const auto omega = failures::parameter(analysis, "natural_frequency_rad_per_s");
      REQUIRE(omega);
      CHECK(omega->status == slipfit::ParameterStatus::Conditional);
      check_not_confidently_wrong(analysis, scene);
    });
  }
}

TEST_CASE("overconfidence: static friction that scatters widens the intervals") {
  for (const double jitter : {0.01, 0.1, 0.3}) {
    atlas::Factors factors;
    factors.jitter = jitter;
    for_each_fit(factors, check_not_confidently_wrong);
  }
}

TEST_CASE("no resolution: a slip between two samples gives no natural frequency, with a reason") {
  for (const double samples_per_slip : {0.5, 1.0}) {
    atlas::Factors factors;
    factors.samples_per_slip = samples_per_slip;
    for_each_fit(factors, [](const slipfit::Analysis& analysis, const atlas::Scene& scene) {
      const auto omega = failures::parameter(analysis, "natural_frequency_rad_per_s");
      if (omega) CHECK((omega->status != slipfit::ParameterStatus::Identified || omega->estimate.ci95));
      check_not_confidently_wrong(analysis, scene);
      if (omega && !omega->estimate.value) CHECK_FALSE(omega->estimate.note.empty());
    });
  }
}

TEST_CASE("noise as large as the slips: no parameters") {
  for (const double noise : {0.5, 1.0, 3.0}) {
    atlas::Factors factors;
    factors.noise = noise;
    for_each_fit(factors, check_nothing_claimed);
  }
}

TEST_CASE(
    "hum smaller or larger than the slips: fitted beside them, or nothing is claimed (once k was five times too "
    "large)") {
  for (const double hum : {0.1, 0.3, 0.7, 1.0, 1.5, 3.0}) {
    atlas::Factors factors;
    factors.hum = hum;
    for_each_fit(factors, check_not_confidently_wrong);
  }
}

TEST_CASE("outside the model: a solve that ends with refused steps keeps its last solution") {
  // Coulomb friction cannot follow these slips: steps towards them lead to cycles without a solution.
  atlas::Factors factors;
  factors.weakening = 0.8;
  factors.noise = 0.002 * std::pow(300.0, 4.0 / 7.0);  // with seed 7009 this once left such a cycle behind
  for (std::uint64_t seed = 7006; seed < 7012; ++seed) {
    CAPTURE(seed);
    const slipfit::Analysis analysis = slipfit::analyze_and_fit(atlas::make_scene(factors, seed).recording);
    CHECK(analysis.motion == slipfit::MotionClass::StickSlip);
  }
}

TEST_CASE("an average that is not stated: slips behind it are not taken for slow ones without damping") {
  for (const double noise : {0.02, 0.05}) {
    atlas::Factors factors;
    factors.average = 4.9;
    factors.noise = noise;
    for_each_fit(factors, check_not_confidently_wrong, 2 * kSeeds);  // of seed 11 half of w_n was once told
  }
}

TEST_CASE("hum in step with the cycles: nothing is identified (once k was a quarter off, with 50 standard errors)") {
  // 49.3 Hz, and 31.2 Hz whose second harmonic lies near 60 Hz, for half a second
  for (const double speed_m_per_s : {0.0224, 0.0098}) {
    for (const double hum_N : {0.02, 0.04, 0.06}) {
      const auto slider = slipfit::Slider::create(1573.2, 379.0, 0.0717).value();
      const auto friction = slipfit::Friction::create(1.2, 1.0).value();
      const slipfit::SimulationOptions options{
          .duration_s = 0.5, .sample_rate_Hz = 5000.0, .noise_rms_N = 0.0035, .hum_N = hum_N};
      slipfit::SimulatedTrace trace = simulate(slider, friction, speed_m_per_s, options);
      const slipfit::Recording recording =
          test::recording_of(std::move(trace.time_s), std::move(trace.force_N), speed_m_per_s);
      const slipfit::Analysis analysis = slipfit::analyze_and_fit(recording);
      INFO(speed_m_per_s << " m/s, hum " << hum_N << " N, " << analysis.frequency.quoted.value.value_or(0.0) << " Hz");
      if (analysis.motion != slipfit::MotionClass::StickSlip) continue;
      REQUIRE(analysis.fit);
      for (const slipfit::Parameter& parameter : analysis.fit->parameters) {
        CHECK(parameter.status != slipfit::ParameterStatus::Identified);
      }
      CHECK(std::any_of(analysis.warnings.begin(), analysis.warnings.end(),
                        [](const auto& warning) { return warning.code == "mains_in_step"; }));
    }
  }
}
