// The regions of docs/accuracy/failures_frequency_noise.svg and failures_frequency_hum.svg.

#include <catch2/catch.hpp>

#include "scoring.hpp"

namespace {

constexpr std::uint64_t kSeedsOfFactor = 6;

/// Asks both commands; the quoted frequency is right, has an interval that holds the truth, or is absent with a reason.
void check_frequency(const atlas::Factors& factors) {
  for (std::uint64_t seed = 1; seed <= kSeedsOfFactor; ++seed) {
    const atlas::Scene scene = atlas::make_scene(factors, seed);
    INFO("seed " << seed << " noise " << factors.noise << " hum " << factors.hum << " jitter " << factors.jitter
                 << " cycles " << factors.cycles);
    for (const slipfit::Analysis& analysis :
         {slipfit::analyze(scene.recording), slipfit::analyze_and_fit(scene.recording)}) {
      const slipfit::Estimate& quoted = analysis.frequency.quoted;
      INFO("quoted " << quoted.value.value_or(0.0) * scene.cycle.period_s << " of the truth, "
                     << "method " << static_cast<int>(analysis.frequency.method) << ", " << analysis.motion_reason);
      CHECK_FALSE(failures::frequency_is_wrong(analysis, scene));
      CHECK((quoted.value.has_value() || !quoted.note.empty()));
    }
  }
}

}  // namespace

TEST_CASE("octave error: noise that hides the slips does not set the frequency") {
  for (const double noise : {0.2, 0.3, 0.5, 0.8, 1.5, 4.0}) {
    atlas::Factors factors;
    factors.noise = noise;
    check_frequency(factors);
  }
}

TEST_CASE("mains: hum larger than the slips is not taken for them") {
  for (const double hum : {0.3, 0.5, 0.7, 1.0, 1.5, 3.0}) {
    atlas::Factors factors;
    factors.hum = hum;
    check_frequency(factors);
  }
}

TEST_CASE("mains: hum that is counted among scattering slips is not quoted, or the interval reaches to the truth") {
  constexpr int kScenes = 14;
  for (const double jitter : {0.03, 0.14, 0.3}) {
    atlas::Factors factors;
    factors.hum = 0.44;
    factors.jitter = jitter;
    int answered = 0, wrong = 0;
    for (int i = 0; i < kScenes; ++i) {
      const atlas::Scene scene = atlas::make_scene(factors, 5000 + static_cast<std::uint64_t>(i));
      const slipfit::Analysis analysis = slipfit::analyze(scene.recording);
      const slipfit::Estimate& quoted = analysis.frequency.quoted;
      const bool gross = quoted.value && std::abs(*quoted.value * scene.cycle.period_s - 1.0) > 0.05;
      answered += quoted.value ? 1 : 0;
      wrong += gross && failures::frequency_is_wrong(analysis, scene) ? 1 : 0;
      CHECK((quoted.value.has_value() || !quoted.note.empty()));
    }
    INFO("jitter " << jitter << ", answered " << answered);
    CHECK(wrong <=
          1);  // intervals of 95 %: two of fourteen have a chance of 15 %, but only a few are off by 5 % at all
    if (jitter < 0.2) CHECK(answered >= 10);
  }
}

TEST_CASE("drift of a hundred drops does not move the frequency") {
  atlas::Factors factors;
  factors.drift = 100.0;
  check_frequency(factors);
}

TEST_CASE("few cycles in noise: a frequency within its interval or none") {
  for (const double noise : {0.02, 0.5, 2.0}) {
    atlas::Factors factors;
    factors.cycles = 5.0;
    factors.noise = noise;
    check_frequency(factors);
  }
}
