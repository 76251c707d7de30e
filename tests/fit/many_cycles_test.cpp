// Recordings with more cycles than a fit needs.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "fit/cycle/cycle_data.hpp"
#include "fit/cycle/start.hpp"
#include "scene.hpp"
#include "support/recordings.hpp"

using namespace slipfit;

namespace {

Scene scene_of_many_cycles() {
  return {.cycles = 6000.0, .samples_per_slip = 8.0, .jitter = 0.03, .noise = 0.02, .drift_over_drop = 1.0};
}

}  // namespace

TEST_CASE("a part of many cycles gives the parameters, and the warning says so") {
  const Scene s = scene_of_many_cycles();
  const Analysis analysis = analyze_and_fit(record(s));
  REQUIRE(analysis.motion == MotionClass::StickSlip);
  CHECK(has_warning(analysis, "part_of_cycles_fitted"));
  CHECK(!has_warning(analysis, "hum_fitted"));
  CHECK(analysis.cycles.used <= 512);
  CHECK(analysis.cycles.used > 490);
  CHECK(std::abs(static_cast<double>(analysis.cycles.count) - s.cycles) < 0.01 * s.cycles);
  check_truth(analysis, s);

  const Slider slider = Slider::create(s.stiffness, s.omega, s.zeta).value();
  const double period_s =
      damped_motion(slider, Friction::create(s.static_N, s.kinetic_N).value(), s.speed).cycle->period_s;
  const Estimate& frequency = analysis.frequency.quoted;
  CHECK(std::abs(*frequency.value - 1.0 / period_s) < 4.0 * *frequency.standard_error);
  CHECK(*frequency.standard_error < 1e-3 / period_s);
}

TEST_CASE("hum that adds slips to many is taken off where a few of them show it, and the parameters are those below") {
  const Scene s{.stiffness = 5000.0,
                .omega = 900.0,
                .static_N = 4.2,
                .kinetic_N = 3.2,
                .cycles = 400.0,
                .jitter = 0.05,
                .noise = 0.02,
                .hum = 0.6};
  const Recording recording = record(s);
  const std::size_t seen = find_slips(recording, assess_quality(recording)).slips.size();
  CHECK(static_cast<double>(seen) > 1.2 * s.cycles);
  const Analysis analysis = analyze_and_fit(recording);
  CHECK(std::abs(static_cast<double>(analysis.cycles.count) - s.cycles) < 0.01 * s.cycles);
  CHECK(has_warning(analysis, "hum_fitted"));
  check_truth(analysis, s);
}

TEST_CASE("hum of few waves hides more slips than it shows, and they are fitted beneath it") {
  constexpr double kSaws_Hz = 93.0;
  constexpr double kRise = 0.9;  // of the period
  std::vector<double> time_s, force;
  for (int i = 0; i < 24000; ++i) {
    time_s.push_back(5e-5 * i);
    const double phase = std::fmod(kSaws_Hz * time_s.back(), 1.0);
    const double saw = phase < kRise ? phase / kRise : (1.0 - phase) / (1.0 - kRise);
    force.push_back(2.0 + saw + 1.5 * std::sin(2.0 * std::numbers::pi * 50.0 * time_s.back() + 1.0));
  }
  const Recording recording = test::recording_of(time_s, force, 0.01);
  REQUIRE(find_slips(recording, assess_quality(recording)).slips.size() < 66);
  const Analysis analysis = analyze_and_fit(recording);
  CHECK(analysis.cycles.count == 111);
  CHECK(*analysis.frequency.quoted.value == Approx(kSaws_Hz).epsilon(1e-5));
  // The fit's slips are no straight falls: they take a share of the rise.
  CHECK(*parameter(analysis, "stiffness_N_per_m").estimate.value == Approx(kSaws_Hz / kRise / 0.01).epsilon(0.01));
}

TEST_CASE("lines that keep the phase of the slips are of the cycles' shape and not of the mains") {
  // Straight ramps at 25 Hz with sudden falls: what the model misses of them repeats at 50, 100, 150 Hz and so on.
  constexpr int kPeriod = 400;
  std::vector<double> time_s, force;
  for (int i = 0; i < 100 * kPeriod; ++i) {
    time_s.push_back(1e-4 * i);
    force.push_back(3.0 + static_cast<double>(i % kPeriod) / kPeriod);
  }
  const Analysis analysis = analyze_and_fit(test::recording_of(time_s, force, 0.01));
  REQUIRE(analysis.motion == MotionClass::StickSlip);
  CHECK(!has_warning(analysis, "hum_fitted"));
  CHECK(std::abs(*parameter(analysis, "stiffness_N_per_m").estimate.value - 2500.0) < 1.0);
}

TEST_CASE("hum beside a part of the cycles is one line, also where exactly regular cycles make images of it") {
  for (const double jitter : {0.0, 0.005, 0.03}) {
    for (const double hum : {0.005, 0.05, 0.2}) {
      Scene s = scene_of_many_cycles();
      s.cycles = 3000.0;
      s.hum = hum;
      s.jitter = jitter;
      const Analysis analysis = analyze_and_fit(record(s));
      INFO("jitter " << jitter << ", hum " << hum);
      REQUIRE(analysis.motion == MotionClass::StickSlip);
      const auto warning = std::find_if(analysis.warnings.begin(), analysis.warnings.end(),
                                        [](const Warning& w) { return w.code == "hum_fitted"; });
      REQUIRE(warning != analysis.warnings.end());
      CHECK(warning->message.find("at 50 Hz") != std::string::npos);
      check_truth(analysis, "stiffness_N_per_m", s.stiffness);
      check_truth(analysis, "friction_difference_N", s.static_N - s.kinetic_N);
    }
  }
}

TEST_CASE("all lines of hum are found, also those that its strongest hides at first") {
  Scene s = scene_of_many_cycles();
  s.cycles = 3000.0;
  s.jitter = 0.0;
  s.samples_per_slip = 16.0;
  const Recording without = record(s);
  std::vector<double> force(without.force().begin(), without.force().end());
  for (std::size_t i = 0; i < force.size(); ++i) {
    const double turns = 50.0 * without.time_s()[i];
    force[i] += 0.1 * std::sin(2.0 * std::numbers::pi * turns) + 0.02 * std::sin(6.0 * std::numbers::pi * turns) +
                0.005 * std::sin(10.0 * std::numbers::pi * turns);
  }
  const Analysis analysis = analyze_and_fit(test::with_force(without, std::move(force)));
  REQUIRE(analysis.fit);
  const auto warning = std::find_if(analysis.warnings.begin(), analysis.warnings.end(),
                                    [](const Warning& w) { return w.code == "hum_fitted"; });
  REQUIRE(warning != analysis.warnings.end());
  CHECK(warning->message.find("at 50, 150, 250 Hz") != std::string::npos);
  check_truth(analysis, "stiffness_N_per_m", s.stiffness);
}
