#include "slipfit/signal/quality.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>

#include "traces.hpp"

using namespace slipfit;

namespace {

std::vector<double> rounded(std::vector<double> values, double step) {
  for (double& value : values) value = std::round(value / step) * step;
  return values;
}

Quality assess(std::vector<double> force, double rate_Hz = 1000.0) {
  const std::vector<double> time_s = traces::clock(force.size(), rate_Hz);
  return assess_quality(traces::recording(time_s, std::move(force)));
}

/// A saw-tooth of so many samples a period and a fall, with noise.
std::vector<double> noisy_saw_tooth(double samples_a_period, double slip_samples, double noise, std::uint64_t seed) {
  traces::Generator generator(seed);
  std::vector<double> force = traces::saw_tooth({1000.0 / samples_a_period, 0.02, slip_samples / samples_a_period},
                                                traces::clock(20000, 1000.0), generator);
  traces::add_noise(force, noise, generator);
  return force;
}

}  // namespace

TEST_CASE("noise is found under a saw-tooth") {
  for (const double noise : {1e-4, 1e-3, 1e-2, 1e-1}) {
    // 5 %: the median of 40 000 values is good to 1 %, the smaller of two estimates lies a little low.
    CHECK(assess(noisy_saw_tooth(400.0, 20.0, noise, 11)).noise_rms == Approx(noise).epsilon(0.05));
  }
}

TEST_CASE("noise is found under a wave with few samples a period") {
  traces::Generator generator(12);
  const std::vector<double> time_s = traces::clock(20000, 1000.0);
  std::vector<double> force(time_s.size(), 0.0);
  traces::add_sine(force, time_s, 1000.0 / 17.0, 1.0);
  traces::add_noise(force, 0.02, generator);
  const double found = assess(force).noise_rms;
  CHECK(found > 0.018);
  CHECK(found < 0.04);  // second differences alone say 0.08
}

TEST_CASE("a constant force has no noise, no step, no clipping") {
  const Quality quality = assess(std::vector<double>(1000, 2.5));
  CHECK(quality.noise_rms == 0.0);
  CHECK_FALSE(quality.quantisation_step);
  CHECK_FALSE(quality.clip_high);
  CHECK_FALSE(quality.clip_low);
  CHECK(quality.clipped_samples == 0);
  CHECK(quality.impulses == 0);
  CHECK(quality.impulse_mask.empty());
}

TEST_CASE("the step of a coarse converter is found, through the rounding of the file too") {
  const std::vector<double> smooth = noisy_saw_tooth(400.0, 20.0, 0.002, 13);
  const double step = 0.0048828125;
  CHECK(assess(rounded(smooth, step)).quantisation_step.value() == Approx(step).epsilon(1e-6));
  const Quality printed = assess(rounded(rounded(smooth, step), 1e-5));
  CHECK(printed.quantisation_step.value() == Approx(step).epsilon(1e-3));
  CHECK(printed.noise_rms > 0.0014);  // rounding alone makes step / sqrt(12)
}

TEST_CASE("a step with an offset, and one so coarse that most differences are nought") {
  std::vector<double> force = rounded(noisy_saw_tooth(2000.0, 20.0, 1e-4, 14), 0.05);
  for (double& value : force) value += 0.0123;
  const Quality quality = assess(force);
  CHECK(quality.quantisation_step.value() == Approx(0.05).epsilon(1e-6));
  CHECK(quality.noise_rms == Approx(0.05 / std::sqrt(12.0)).epsilon(0.05));
}

TEST_CASE("decimals finer than the noise are no step, neither are free values") {
  const std::vector<double> smooth = noisy_saw_tooth(400.0, 20.0, 0.02, 15);
  CHECK_FALSE(assess(smooth).quantisation_step);
  CHECK_FALSE(assess(rounded(smooth, 0.001)).quantisation_step);  // 0.05 of the noise
  CHECK_FALSE(assess(rounded(smooth, 1e-6)).quantisation_step);
}

TEST_CASE("a few levels that are no lattice have no step") {
  std::vector<double> force(4000);
  constexpr std::array kLevels{0.0, 1.0, 2.43, 3.99, 5.62, 7.18, 8.51};
  for (std::size_t i = 0; i < force.size(); ++i) force[i] = kLevels[(i / 3) % kLevels.size()];
  CHECK_FALSE(assess(force).quantisation_step);
}

TEST_CASE("a saturated sensor is found at either end") {
  std::vector<double> force = noisy_saw_tooth(400.0, 20.0, 0.01, 16);
  for (double& value : force) value = std::clamp(value, 0.1, 0.85);
  const auto at = [&](double level) { return static_cast<std::size_t>(std::count(force.begin(), force.end(), level)); };
  const Quality quality = assess(force);
  CHECK(quality.clip_high.value() == 0.85);
  CHECK(quality.clip_low.value() == 0.1);
  CHECK(quality.clipped_samples == at(0.85) + at(0.1));
}

TEST_CASE("rounded tops, coarse levels and a force at rest are not clipping") {
  CHECK_FALSE(assess(noisy_saw_tooth(400.0, 20.0, 0.01, 17)).clip_high);
  for (const double step : {0.3, 0.1, 0.02, 0.005}) {
    const Quality quality = assess(rounded(noisy_saw_tooth(400.0, 20.0, 1e-4, 18), step));
    CAPTURE(step);
    CHECK_FALSE(quality.clip_high);
    CHECK_FALSE(quality.clip_low);
  }
  std::vector<double> wave(8000, 0.0);  // stays longest at its crests
  traces::add_sine(wave, traces::clock(wave.size(), 1000.0), 2.51, 1.0);
  CHECK_FALSE(assess(rounded(wave, 0.1)).clip_high);
  std::vector<double> rest(1000, 1.0);
  for (std::size_t i = 0; i < rest.size(); i += 50) rest[i] = 0.99;
  CHECK_FALSE(assess(rest).clip_high);
}

TEST_CASE("isolated impulses of one and two samples are found, all of them and nothing else") {
  std::vector<double> force = noisy_saw_tooth(400.0, 20.0, 0.01, 19);
  std::vector<bool> planted(force.size(), false);
  traces::Generator generator(20);
  for (std::size_t i = 150; i + 10 < force.size(); i += 211) {
    if (std::abs(force[i + 5] - force[i - 5]) > 0.15) continue;  // in a slip nobody can tell
    const double size = generator() % 2 == 0 ? 0.4 : -0.6;
    force[i] += size;
    planted[i] = true;
    if (generator() % 2 == 0) force[i + 1] += 0.8 * size, planted[i + 1] = true;
  }
  const Quality quality = assess(force);
  REQUIRE(quality.impulse_mask.size() == force.size());
  std::size_t missed = 0;
  std::size_t invented = 0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (planted[i] && !quality.impulse_mask[i]) ++missed;
    if (!planted[i] && quality.impulse_mask[i]) ++invented;
  }
  CHECK(missed == 0);
  CHECK(invented == 0);
  CHECK(quality.impulses == static_cast<std::size_t>(std::count(planted.begin(), planted.end(), true)));
}

TEST_CASE("no slip is an impulse, however few samples it has") {
  for (const double samples_a_period : {4.0, 5.3, 8.0, 17.0, 60.0, 400.0}) {
    for (const double slip_samples : {0.0, 0.7, 1.5, 2.5, 3.5}) {
      for (const double noise : {0.0, 1e-5, 1e-3, 1e-2}) {
        if (slip_samples > 0.5 * samples_a_period) continue;
        CAPTURE(samples_a_period, slip_samples, noise);
        CHECK(assess(noisy_saw_tooth(samples_a_period, slip_samples, noise, 21)).impulses == 0);
      }
    }
  }
}

TEST_CASE("no crest of a wave is an impulse") {
  for (const double samples_a_period : {3.1, 4.0, 6.0, 6.7, 11.0, 17.0, 100.0}) {
    const std::vector<double> time_s = traces::clock(5000, 1000.0);
    std::vector<double> force(time_s.size(), 0.0);
    traces::add_sine(force, time_s, 1000.0 / samples_a_period, 1.0);
    CAPTURE(samples_a_period);
    CHECK(assess(force).impulses == 0);
  }
}

TEST_CASE("Gaussian noise has no impulses") {
  traces::Generator generator(22);
  CHECK(assess(traces::noise_with_memory(200000, 0.0, generator)).impulses == 0);
}

TEST_CASE("gaps and jitter of the clock") {
  traces::Generator generator(23);
  std::normal_distribution<double> normal(0.0, 1e-4);
  std::vector<double> time_s(5000);
  double t = 0.0;
  for (double& stamp : time_s) stamp = t += 1e-3 + normal(generator);
  for (std::size_t i = 1000; i < time_s.size(); ++i) time_s[i] += 0.02;
  for (std::size_t i = 3000; i < time_s.size(); ++i) time_s[i] += 0.005;
  const Quality quality = assess_quality(traces::recording(time_s, std::vector<double>(time_s.size(), 1.0)));
  CHECK(quality.gaps == 2);
  CHECK(quality.longest_gap_s == Approx(0.021).margin(4e-4));
  CHECK(quality.clock_jitter == Approx(0.1).epsilon(0.06));
  CHECK(assess(std::vector<double>(100, 1.0)).gaps == 0);
  CHECK(assess(std::vector<double>(100, 1.0)).clock_jitter < 1e-9);
}

TEST_CASE("the defects of the synthetic set are found and the clean ones have none") {
  const auto table = traces::load_table(traces::shared("synthetic/truth.csv"));
  if (table.empty()) {
    WARN("skipped: no shared data");
    return;
  }
  for (const auto& row : table) {
    const auto recording = traces::load(traces::shared("synthetic/" + row.at("id") + ".csv"));
    REQUIRE(recording);
    const Quality quality = assess_quality(*recording);
    const std::string& note = row.at("note");
    CAPTURE(row.at("id"), note);
    CHECK(quality.clip_high.has_value() == (note == "clipped"));
    CHECK_FALSE(quality.clip_low);
    CHECK(quality.quantisation_step.has_value() == (note == "quantised"));
    CHECK((quality.impulses > 20) == (note == "impulses"));
    CHECK((quality.impulses > 0) == (note == "impulses"));
    CHECK((quality.gaps > 0) == (note == "dropout"));
    CHECK((quality.clock_jitter > 0.01) == (note == "uneven"));
  }
}

TEST_CASE("the defects of measured recordings are found") {
  const auto wandering = traces::load(traces::shared("real/colas/colas_k168_v42.csv"));
  const auto uneven = traces::load(traces::shared("real/fdm/fdm_77g_50mm_min.csv"));
  if (!wandering || !uneven) {
    WARN("skipped: no shared data");
    return;
  }
  const Quality quality = assess_quality(*wandering);
  CHECK(quality.impulses > 500);
  CHECK(quality.impulses < 6000);  // 1-3 % were seen by eye and by a coarser rule
  CHECK(quality.quantisation_step.has_value());
  CHECK_FALSE(quality.clip_high);
  CHECK(assess_quality(*uneven).gaps > 0);
  CHECK_FALSE(assess_quality(*uneven).clip_high);
}
