// A ring-down as data of w_n and zeta: where it is the motion of the slips, and where it is not.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "fit/inference/free_motion.hpp"
#include "scene.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"
#include "support/holds.hpp"
#include "support/recordings.hpp"
#include "sweep_recordings.hpp"

using namespace slipfit;

namespace {

/// The recording, let go at rest at its end: its spring force rings down freely, `times` the natural frequency.
Recording with_release(const Scene& scene, double times) {
  Scene exact = scene;
  exact.noise = 0.0;
  const Recording recording = record(exact);
  std::vector<double> time_s(recording.time_s().begin(), recording.time_s().end());
  std::vector<double> force(recording.force().begin(), recording.force().end());
  const double from_s = time_s.back();
  const double from_N = force.back();
  const double decay = scene.zeta * times * scene.omega;
  const double damped = std::sqrt(1.0 - scene.zeta * scene.zeta) * times * scene.omega;
  for (double t = recording.sample_interval_s(); t < 8.0 / decay; t += recording.sample_interval_s()) {
    time_s.push_back(from_s + t);
    force.push_back(from_N * std::exp(-decay * t) * (std::cos(damped * t) + decay / damped * std::sin(damped * t)));
  }
  std::mt19937_64 random(scene.seed);
  std::normal_distribution<double> normal;
  for (double& one : force) one += scene.noise * (scene.static_N - scene.kinetic_N) * normal(random);
  return Recording::create(std::move(time_s), std::move(force), recording.conditions()).value();
}

double width(const Parameter& parameter) {
  return parameter.estimate.ci95->high - parameter.estimate.ci95->low;
}

/// Slips that averaging hides, or few and noisy ones.
Recording averaged(const Recording& recording, std::size_t samples) {
  return samples > 1 ? moving_average(recording, samples, 0.003, 5) : recording;
}

bool uses_ring_down(const std::vector<std::string>& conditions) {
  return std::any_of(conditions.begin(), conditions.end(),
                     [](const std::string& one) { return one.find("ring-down") != std::string::npos; });
}

}  // namespace

TEST_CASE("a ring-down that is the motion of the slips tells w_n and zeta with them", "[ring_down]") {
  Scene scene{.cycles = 12.0, .noise = 0.02};
  const std::size_t samples = GENERATE(std::size_t{1}, std::size_t{24});
  if (samples > 1) scene.noise = 0.0;
  const Recording whole = averaged(with_release(scene, 1.0), samples);
  const Recording slips = averaged(record(scene), samples);
  const Analysis joined = analyze_and_fit(whole);
  const Analysis alone = analyze_and_fit(slips);
  REQUIRE(joined.motion == MotionClass::StickSlip);
  INFO("averaged over " << samples << " samples");
  CHECK(uses_ring_down(joined.fit->conditional_on));
  CHECK_FALSE(uses_ring_down(alone.fit->conditional_on));
  CHECK(width(parameter(joined, "damping_ratio")) < 0.5 * width(parameter(alone, "damping_ratio")));
  CHECK(width(parameter(joined, "natural_frequency_rad_per_s")) <
        width(parameter(alone, "natural_frequency_rad_per_s")));
  CHECK(test::holds(parameter(joined, "damping_ratio").estimate, scene.zeta));
  CHECK(test::holds(parameter(joined, "natural_frequency_rad_per_s").estimate, scene.omega));
  CHECK(test::holds(parameter(joined, "friction_difference_N").estimate, scene.static_N - scene.kinetic_N));
  CHECK(test::holds(parameter(joined, "stiffness_N_per_m").estimate, scene.stiffness));
}

TEST_CASE("a ring-down of another mode is told and changes nothing", "[ring_down]") {
  Scene scene;
  scene.noise = 0.01;
  const Recording whole = with_release(scene, 1.3);
  const Analysis joined = analyze_and_fit(whole);
  CHECK(has_warning(joined, "ring_down_differs"));
  CHECK_FALSE(uses_ring_down(joined.fit->conditional_on));
  const Analysis alone = analyze_and_fit(whole.part(0, record(scene).size()));
  CHECK_FALSE(has_warning(alone, "ring_down_differs"));
  CHECK(*parameter(joined, "damping_ratio").estimate.value ==
        Approx(*parameter(alone, "damping_ratio").estimate.value).margin(0.01));
  CHECK(test::holds(parameter(joined, "natural_frequency_rad_per_s").estimate, scene.omega));
}

TEST_CASE("a ring-down of one recording is data of a whole sweep", "[ring_down]") {
  const test::SweepScene scene{.f1_N = 0.0, .cycles = 6.0, .samples_per_half_period = 6.0, .noise_N = 0.03};
  const std::vector<SweepEntry> entries = test::record_sweep(scene, {0.004, 0.008, 0.016});
  std::vector<Quality> qualities;
  std::vector<Segmentation> slips;
  for (const SweepEntry& entry : entries) qualities.push_back(assess_quality(entry.recording));
  for (std::size_t i = 0; i < entries.size(); ++i) slips.push_back(find_slips(entries[i].recording, qualities[i]));
  const auto fitted = [&](std::optional<RingDown> ring) {
    std::vector<SweepRecording> recordings;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      recordings.push_back({entries[i].recording, qualities[i], slips[i], SweepRole::Cycles});
    }
    recordings.back().ring_down = std::move(ring);
    return fit_sweep(recordings, {});
  };
  const double frequency_Hz = scene.natural_frequency_rad_per_s *
                              std::sqrt(1.0 - scene.damping_ratio * scene.damping_ratio) / (2.0 * std::numbers::pi);
  const auto ring_of = [&](double times) {
    const double f = times * frequency_Hz;
    return RingDown{{f, 0.001 * f, Interval{0.998 * f, 1.002 * f}, {}}, {0.06, 0.001, Interval{0.058, 0.062}, {}}};
  };
  const std::optional<SweepFit> alone = fitted(std::nullopt);
  const std::optional<SweepFit> joined = fitted(ring_of(1.0));
  const std::optional<SweepFit> differs = fitted(ring_of(1.2));
  REQUIRE((alone && joined && differs));
  CHECK(joined->ring_down_used);
  CHECK_FALSE(alone->ring_down_used);
  CHECK_FALSE(differs->ring_down_used);
  CHECK(width(*joined->result.find(ParameterId::DampingRatio)) <
        0.5 * width(*alone->result.find(ParameterId::DampingRatio)));
  CHECK(test::holds(joined->result.find(ParameterId::DampingRatio)->estimate, scene.damping_ratio));
  CHECK(test::holds(joined->result.find(ParameterId::NaturalFrequency)->estimate, scene.natural_frequency_rad_per_s));
  CHECK(test::holds(joined->result.find(ParameterId::Stiffness)->estimate, scene.stiffness_N_per_m));
  CHECK(test::warns(differs->result.warnings, "ring_down_differs"));
  CHECK_FALSE(test::warns(joined->result.warnings, "ring_down_differs"));
  CHECK(*differs->result.damping_ratio().value == *alone->result.damping_ratio().value);
}
