#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "finding.hpp"

using namespace slipfit;
using traces::check_frequency;
using traces::find;
using traces::find_held;
using traces::names_line;
using traces::noisy_saw_tooth;

TEST_CASE("a saw-tooth is found from 3 cycles to thousands") {
  for (const double cycles : {3.3, 4.4, 5.7, 8.1, 13.9, 30.2, 199.6, 3011.3}) {
    const std::size_t samples = cycles > 100.0 ? 60000 : 4000;
    const double f = cycles * 1000.0 / static_cast<double>(samples);
    const auto found = find(noisy_saw_tooth({f, 0.0, 0.03}, samples, 0.03, 5));
    CAPTURE(cycles, f, found.false_alarm_probability);
    check_frequency(found, f, 0.003);
    CHECK(std::abs(*found.value_Hz - f) < 4.0 * *found.standard_error_Hz);
    REQUIRE_FALSE(found.harmonics_Hz.empty());
    CHECK(found.harmonics_Hz.front() == Approx(f).epsilon(0.03));
    CHECK(found.suspicious_lines.empty());
  }
}

TEST_CASE("a sine is found from 5 cycles on, with one harmonic") {
  for (const double cycles : {5.2, 9.7, 40.4, 1210.9}) {
    traces::Generator generator(6);
    const std::vector<double> time_s = traces::clock(8000, 1000.0);
    std::vector<double> force(time_s.size(), 3.0);
    traces::add_sine(force, time_s, cycles / 8.0, 1.0);
    traces::add_noise(force, 0.05, generator);
    const auto found = find(traces::recording(time_s, force));
    CAPTURE(cycles);
    check_frequency(found, cycles / 8.0, 0.002);
    CHECK(found.harmonics_Hz.size() == 1);
  }
}

TEST_CASE("slow wander larger than the drop does not conceal the sawtooth") {
  traces::Generator generator(7);
  const std::vector<double> time_s = traces::clock(20000, 1000.0);
  std::vector<double> force = traces::saw_tooth({2.63, 0.02, 0.03}, time_s, generator);
  const std::vector<double> walk = traces::noise_with_memory(time_s.size(), 1.0, generator);
  for (std::size_t i = 0; i < force.size(); ++i) force[i] += 0.02 * walk[i];  // wanders by 2.8 drops
  check_frequency(find(traces::recording(time_s, force)), 2.63, 0.02);
}

TEST_CASE("one force near the largest double does not end the program") {
  const std::vector<double> time_s = traces::clock(600, 50.0);
  std::vector<double> force;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    force.push_back(0.01 * static_cast<double>(i % 25) + 0.001 * static_cast<double>(7919 * i % 13));
  }
  force[130] = -8e36;
  CHECK_NOTHROW(find_held(traces::recording(time_s, force), 2.0));
}

TEST_CASE("hum is named and not chosen") {
  for (const double mains_Hz : {50.0, 60.0}) {
    traces::Generator generator(8);
    const std::vector<double> time_s = traces::clock(20000, 1000.0);
    std::vector<double> force = traces::saw_tooth({3.37, 0.01, 0.03}, time_s, generator);
    traces::add_noise(force, 0.05, generator);
    traces::add_sine(force, time_s, mains_Hz * 1.0004, 3.0);  // six times the amplitude of the saw-tooth
    traces::add_sine(force, time_s, mains_Hz * 3.0012, 1.0);
    const auto found = find(traces::recording(time_s, force));
    check_frequency(found, 3.37, 0.01);
    CHECK(names_line(found, mains_Hz, mains_Hz == 50.0 ? "mains 50 Hz" : "mains 60 Hz"));
    CHECK(names_line(found, 3.0 * mains_Hz,
                     mains_Hz == 50.0 ? "3rd harmonic of 50 Hz mains" : "3rd harmonic of 60 Hz mains"));
  }
}

TEST_CASE("a wave at the frequency of the mains that dies out is not hum") {
  traces::Generator generator(9);
  const std::vector<double> time_s = traces::clock(4000, 2000.0);
  std::vector<double> force(time_s.size(), 3.0);
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    force[i] += std::exp(-6.0 * time_s[i]) * std::sin(2.0 * 3.141592653589793 * 60.02 * time_s[i]);
  }
  traces::add_noise(force, 0.001, generator);
  const auto found = find(traces::recording(time_s, force));
  CHECK(found.suspicious_lines.empty());
  check_frequency(found, 60.02, 0.01);
}

TEST_CASE("ten periods beside the mains are no hum where the peak shows the difference") {
  for (const double f : {48.7, 51.3, 61.4}) {  // a quarter of the resolution away
    CAPTURE(f);
    traces::Generator generator(10);
    const std::vector<double> time_s = traces::clock(215, 1024.0);
    std::vector<double> force(time_s.size(), 3.0);
    traces::add_sine(force, time_s, f, 1.0);
    traces::add_sine(force, time_s, 2.0 * f, 0.3);
    traces::add_noise(force, 0.03, generator);
    const auto found = find(traces::recording(time_s, force));
    CHECK(found.suspicious_lines.empty());
    check_frequency(found, f, 0.01);
  }
}

TEST_CASE("hum in the gap between two lines of the comb does not count as background") {
  traces::Generator generator(17);
  const std::vector<double> time_s = traces::clock(8000, 1000.0);
  std::vector<double> force(time_s.size(), 0.0);
  traces::add_sine(force, time_s, 33.4, 0.15);
  traces::add_sine(force, time_s, 50.02, 5.0);  // half way to the second harmonic
  traces::add_noise(force, 0.5, generator);
  check_frequency(find(traces::recording(time_s, force)), 33.4, 0.002);
}

TEST_CASE("four cycles and a fall at both ends: what the harmonic series leaves out does not pull") {
  traces::Generator generator(18);
  const std::vector<double> time_s = traces::clock(4000, 1000.0);
  std::vector<double> force(time_s.size());
  for (std::size_t i = 0; i < force.size(); ++i) force[i] = std::fmod(time_s[i], 1.0);
  traces::add_noise(force, 0.02, generator);
  check_frequency(find(traces::recording(time_s, force)), 1.0, 0.002);  // 0.8 % without a taper
}

TEST_CASE("a bent drift of many drops does not turn the phases") {
  traces::Generator generator(19);
  const std::vector<double> time_s = traces::clock(20000, 1000.0);
  std::vector<double> force = traces::saw_tooth({1.51, 0.0, 0.05}, time_s, generator);
  for (std::size_t i = 0; i < force.size(); ++i)
    force[i] += 0.15 * (time_s[i] - 6.0) * (time_s[i] - 6.0);  // to 29 drops
  traces::add_noise(force, 0.01, generator);
  check_frequency(find(traces::recording(time_s, force)), 1.51, 3e-4);
}

TEST_CASE("hum alone is nothing, unless counting slips agrees with it") {
  traces::Generator generator(9);
  const std::vector<double> time_s = traces::clock(10000, 1000.0);
  std::vector<double> force(time_s.size(), 1.0);
  traces::add_sine(force, time_s, 50.01, 1.0);
  traces::add_noise(force, 0.2, generator);
  const Recording recording = traces::recording(time_s, force);
  const auto blind = find(recording);
  CHECK_FALSE(blind.value_Hz);
  CHECK(names_line(blind, 50.0, "mains 50 Hz"));
  const auto hinted = find(recording, 50.1);
  check_frequency(hinted, 50.01, 1e-4);
}

TEST_CASE("a saw-tooth near the mains frequency, but not at it, is found") {
  check_frequency(find(noisy_saw_tooth({51.3, 0.0, 0.1}, 5000, 0.03, 10)), 51.3, 1e-3);
}

TEST_CASE("a period that is a whole number of mains periods is not called mains") {
  const auto found = find(noisy_saw_tooth({10.0, 0.001, 0.03}, 20000, 0.02, 11));
  check_frequency(found, 10.0, 1e-3);
  CHECK(found.suspicious_lines.empty());
}

TEST_CASE("scattering periods: no octave error, with and without a hint") {
  for (const double jitter : {0.02, 0.05, 0.1}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Recording recording = noisy_saw_tooth({1.7, jitter, 0.03}, 30000, 0.03, seed);  // 51 cycles
      CAPTURE(jitter, seed);
      const auto found = find(recording);
      check_frequency(found, 1.7, 0.06);
      CHECK(find(recording, 1.8).value_Hz.value() == Approx(1.7).epsilon(0.06));
    }
  }
}

TEST_CASE("a hint decides between octaves and does not conceal a disagreement") {
  // Every second drop is larger: the pattern repeats at half of the slip frequency.
  traces::Generator generator(12);
  const std::vector<double> time_s = traces::clock(20000, 1000.0);
  std::vector<double> force = traces::saw_tooth({4.0, 0.0, 0.03}, time_s, generator);
  traces::add_sine(force, time_s, 2.0, 0.3);
  traces::add_noise(force, 0.02, generator);
  const Recording recording = traces::recording(time_s, force);
  CHECK(find(recording, 4.0).value_Hz.value() == Approx(4.0).epsilon(0.001));
  CHECK(find(recording, 2.1).value_Hz.value() == Approx(2.0).epsilon(0.001));
  // Nothing near 23 Hz but the comb of the saw-tooth itself elsewhere.
  const auto elsewhere = find(noisy_saw_tooth({4.0, 0.0, 0.2}, 20000, 0.05, 13), 1.1);
  check_frequency(elsewhere, 4.0, 0.001);
}

TEST_CASE("few samples per slip: aliased harmonics do not make a subharmonic") {
  for (const double samples_a_period : {7.4, 16.54, 23.47, 40.52}) {
    const double f = 1000.0 / samples_a_period;
    const auto found = find(noisy_saw_tooth({f, 0.0, 0.0}, 3000, 0.01, 14));
    CAPTURE(samples_a_period, f);
    check_frequency(found, f, 0.002);
  }
}

TEST_CASE("random impulses do not conceal the sawtooth") {
  traces::Generator generator(15);
  const std::vector<double> time_s = traces::clock(20000, 1000.0);
  std::vector<double> force = traces::saw_tooth({1.37, 0.01, 0.03}, time_s, generator);
  traces::add_noise(force, 0.02, generator);
  for (int k = 0; k < 200; ++k) force[generator() % force.size()] += (generator() % 2 == 0 ? 5.0 : -5.0);
  check_frequency(find_held(traces::recording(time_s, force)), 1.37, 0.01);
}

TEST_CASE("recordings without anything periodic to measure are answered, not crashed on") {
  const std::vector<double> time_s = traces::clock(1000, 1000.0);
  CHECK_FALSE(find(traces::recording(time_s, std::vector<double>(1000, 2.0))).value_Hz);
  std::vector<double> ramp(1000);
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = 1e-3 * static_cast<double>(i);
  CHECK_FALSE(find(traces::recording(time_s, ramp)).value_Hz);
  std::vector<double> step(1000, 0.0);
  std::fill(step.begin() + 500, step.end(), 1.0);
  CHECK_FALSE(find(traces::recording(time_s, step)).value_Hz);
  for (std::size_t samples = 2; samples < 40; ++samples) {
    std::vector<double> force(samples);
    for (std::size_t i = 0; i < samples; ++i) force[i] = static_cast<double>(i % 3);
    const Recording recording = traces::recording(traces::clock(samples, 10.0), force);
    CHECK_NOTHROW(find(recording));
    CHECK_NOTHROW(find(recording, 1.0));
    CHECK_NOTHROW(find(recording, 1e9));
    CHECK_NOTHROW(find(recording, 0.0));
  }
}
