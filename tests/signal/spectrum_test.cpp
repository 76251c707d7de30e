#include "slipfit/signal/spectrum.hpp"

#include <catch2/catch.hpp>
#include <complex>
#include <numeric>
#include <thread>

#include "signal/transform.hpp"
#include "traces.hpp"

using namespace slipfit;

namespace {

std::size_t strongest(const Spectrum& spectrum) {
  return static_cast<std::size_t>(std::max_element(spectrum.power.begin(), spectrum.power.end()) -
                                  spectrum.power.begin());
}

/// The definition, term by term: detrend, window, sum.
double power_by_definition(const std::vector<double>& force, std::size_t bin) {
  const auto n = static_cast<double>(force.size());
  double mean = 0.0;
  double moment = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    mean += force[i] / n;
    moment += force[i] * (static_cast<double>(i) - 0.5 * (n - 1.0));
  }
  const double slope = moment / (n * (n * n - 1.0) / 12.0);
  std::complex<double> sum = 0.0;
  double energy = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    const double place = static_cast<double>(i);
    const double window = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (place + 0.5) / n);
    energy += window * window;
    const double value = force[i] - mean - slope * (place - 0.5 * (n - 1.0));
    sum += window * value * std::polar(1.0, -2.0 * std::numbers::pi * place * static_cast<double>(bin) / n);
  }
  const bool both_sides = 2 * bin != force.size();
  return (both_sides ? 2.0 : 1.0) * std::norm(sum) / (n * energy);
}

}  // namespace

TEST_CASE("the spectrum is the transform by its definition") {
  traces::Generator generator(1);
  std::vector<double> force = traces::noise_with_memory(210, 0.7, generator);  // 210 needs no padding
  for (std::size_t i = 0; i < force.size(); ++i) force[i] += 0.3 * static_cast<double>(i);
  const Spectrum spectrum = compute_spectrum(traces::recording(traces::clock(210, 10.0), force));
  REQUIRE(spectrum.power.size() == 106);
  CHECK(spectrum.bin_Hz == Approx(10.0 / 210.0).epsilon(1e-12));
  for (std::size_t bin = 1; bin < spectrum.power.size(); ++bin) {
    CHECK(spectrum.power[bin] == Approx(power_by_definition(force, bin)).epsilon(1e-9).margin(1e-12));
  }
  CHECK(spectrum.power[0] == 0.0);
}

TEST_CASE("the power of a sine is half of its amplitude squared, at its frequency, whatever the length") {
  for (const std::size_t samples : {std::size_t{997}, std::size_t{1000}, std::size_t{4999}}) {
    const std::vector<double> time_s = traces::clock(samples, 500.0);
    std::vector<double> force(samples, 7.0);
    traces::add_sine(force, time_s, 60.3, 2.0);
    const Spectrum spectrum = compute_spectrum(traces::recording(time_s, force));
    CHECK(std::accumulate(spectrum.power.begin(), spectrum.power.end(), 0.0) == Approx(2.0).epsilon(0.01));
    CHECK(std::abs(static_cast<double>(strongest(spectrum)) * spectrum.bin_Hz - 60.3) <= 0.51 * spectrum.bin_Hz);
  }
}

TEST_CASE("lengths are padded to even products of 2, 3, 5 and 7") {
  CHECK(signal::good_length(1) == 4);
  CHECK(signal::good_length(200000) == 200000);
  CHECK(signal::good_length(199999) == 200000);
  CHECK(signal::good_length(2 * 11) == 24);
  CHECK(signal::good_length(422) == 432);  // 211 to 215 have larger primes
  for (std::size_t n = 2; n < 5000; ++n)
    CHECK(static_cast<double>(signal::good_length(n)) <= 1.16 * static_cast<double>(n) + 4.0);
}

TEST_CASE("an uneven clock is resampled: the line stays where it is") {
  traces::Generator generator(2);
  std::uniform_real_distribution<double> uniform(-0.45, 0.45);
  std::vector<double> time_s = traces::clock(4000, 100.0);
  for (double& t : time_s) t = std::max(0.0, t + 0.01 * uniform(generator));
  std::sort(time_s.begin(), time_s.end());
  std::vector<double> force(time_s.size(), 0.0);
  traces::add_sine(force, time_s, 3.21, 1.0);
  const Recording recording = traces::recording(time_s, force);
  REQUIRE_FALSE(recording.clock_is_even());
  const Spectrum spectrum = compute_spectrum(recording);
  CHECK(std::abs(static_cast<double>(strongest(spectrum)) * spectrum.bin_Hz - 3.21) <= 0.51 * spectrum.bin_Hz);
  CHECK(spectrum.power[strongest(spectrum)] > 0.2);  // of 0.5 in all; three bins share it
}

TEST_CASE("decimation keeps ramps and removes frequencies above the new Nyquist frequency") {
  std::vector<double> ramp(1000);
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = 5.0 + 2.0 * static_cast<double>(i);
  const std::vector<double> thinned = signal::thin(ramp, 8);
  REQUIRE(thinned.size() == 125);
  for (std::size_t j = 1; j < thinned.size(); ++j) {
    CHECK(thinned[j] == Approx(2.0 * (8.0 * static_cast<double>(j) - 0.5)));
  }
  std::vector<double> fast(8000, 0.0);
  traces::add_sine(fast, traces::clock(8000, 1000.0), 121.0, 1.0);  // 125 Hz is the new clock: would come back as 4 Hz
  const std::vector<double> slow = signal::thin(fast, 8);
  for (std::size_t j = 1; j < slow.size(); ++j) CHECK(std::abs(slow[j]) < 0.005);  // sinc(121/125)^2 = 0.001
}

TEST_CASE("a burst of samples and a long pause do not fill the memory") {
  std::vector<double> time_s = traces::clock(1000, 1e6);
  time_s.push_back(1000.0);
  const Spectrum spectrum = compute_spectrum(traces::recording(time_s, std::vector<double>(time_s.size(), 0.5)));
  CHECK(spectrum.power.size() < 2 * time_s.size());
}

TEST_CASE("held samples do not reach the spectrum") {
  const std::vector<double> time_s = traces::clock(2000, 100.0);
  std::vector<double> force(time_s.size(), 0.0);
  traces::add_sine(force, time_s, 1.0, 1.0);
  const Spectrum clean = compute_spectrum(traces::recording(time_s, force));
  std::vector<bool> held(force.size(), false);
  for (const std::size_t i : {std::size_t{0}, std::size_t{700}, std::size_t{701}, std::size_t{1999}}) {
    force[i] += 500.0;
    held[i] = true;
  }
  const Recording recording = traces::recording(time_s, force);
  const auto total = [](const Spectrum& s) { return std::accumulate(s.power.begin(), s.power.end(), 0.0); };
  CHECK(total(compute_spectrum(recording)) > 10.0 * total(clean));
  CHECK(total(compute_spectrum(recording, held)) == Approx(total(clean)).epsilon(0.01));
  CHECK_NOTHROW(compute_spectrum(recording, std::vector<bool>(force.size(), true)));
}

TEST_CASE("the shortest and the flattest recordings have a spectrum") {
  CHECK(compute_spectrum(traces::recording({0.0, 1.0}, {1.0, 2.0})).power.size() >= 2);
  const Spectrum flat = compute_spectrum(traces::recording(traces::clock(100, 10.0), std::vector<double>(100, 3.0)));
  for (const double power : flat.power) CHECK(power == 0.0);
}

TEST_CASE("threads share the planner and get the same bytes") {
  traces::Generator generator(3);
  const Recording recording =
      traces::recording(traces::clock(3001, 100.0), traces::noise_with_memory(3001, 0.9, generator));
  const Spectrum alone = compute_spectrum(recording);
  std::vector<Spectrum> results(8);
  std::vector<std::thread> threads;
  threads.reserve(results.size());
  for (std::size_t k = 0; k < results.size(); ++k) {
    threads.emplace_back([&, k] {
      for (std::size_t other = 100; other < 2000; other += 100 + k)
        signal::hann_power(recording.force().first(other), signal::good_length(other));
      results[k] = compute_spectrum(recording);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const Spectrum& result : results) CHECK(result.power == alone.power);
}
