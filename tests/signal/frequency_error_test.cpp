#include <algorithm>
#include <catch2/catch.hpp>

#include "finding.hpp"

using namespace slipfit;
using traces::find;
using traces::noisy_saw_tooth;

namespace {

struct Coverage {
  int found = 0;
  int within = 0;  ///< 1.96 standard errors of the truth
  int astray = 0;  ///< further off than 10 %
  double median_error = 0.0;
  double median_standard_error = 0.0;
};

Coverage coverage(const traces::SawTooth& shape, std::size_t samples, double noise, int seeds) {
  Coverage result;
  std::vector<double> errors;
  std::vector<double> claimed;
  for (int seed = 0; seed < seeds; ++seed) {
    const auto found = find(noisy_saw_tooth(shape, samples, noise, 1000 + static_cast<std::uint64_t>(seed)));
    if (!found.value_Hz) continue;
    ++result.found;
    const double error = std::abs(*found.value_Hz - shape.frequency_Hz);
    if (error < 1.96 * *found.standard_error_Hz) ++result.within;
    if (error > 0.1 * shape.frequency_Hz) ++result.astray;
    errors.push_back(error / shape.frequency_Hz);
    claimed.push_back(*found.standard_error_Hz / shape.frequency_Hz);
  }
  const auto median = [](std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0.0 : values[values.size() / 2];
  };
  result.median_error = median(errors);
  result.median_standard_error = median(claimed);
  return result;
}

}  // namespace

TEST_CASE("a strictly periodic saw-tooth is measured far below one bin, with an honest error") {
  const Coverage result = coverage({2.017, 0.0, 0.05}, 20000, 0.05, 60);  // 40 cycles, one bin is 2.5 %
  CHECK(result.found == 60);
  CHECK(result.median_error < 1e-4);
  CHECK(result.median_standard_error < 3e-4);
  CHECK(result.within >= 52);  // 95 % of 60 is 57; fewer than 52 by chance: 1 in 1000
}

TEST_CASE("scattering periods: the error is the scatter over the root of the cycles, and covers") {
  struct Case {
    double frequency_Hz, jitter;
    int least;  // of 100; 95 would be right, few cycles know their own scatter poorly
  };
  for (const Case& c : {Case{2.03, 0.05, 85}, Case{2.03, 0.1, 84}, Case{15.1, 0.02, 88}, Case{15.1, 0.1, 88}}) {
    const Coverage result = coverage({c.frequency_Hz, c.jitter, 0.03}, 20000, 0.03, 100);
    const double expected = c.jitter / std::sqrt(20.0 * c.frequency_Hz);
    CAPTURE(c.frequency_Hz, c.jitter, expected);
    CHECK(result.found >= 98);
    CHECK(result.astray <= 1);
    CHECK(result.within >= c.least);
    CHECK(result.median_standard_error > 0.7 * expected);
    CHECK(result.median_standard_error < 1.5 * expected);
    CHECK(result.median_error < 1.1 * expected);  // median |z| of a normal is 0.67
  }
}

TEST_CASE("few cycles have a larger standard error of the frequency") {
  const Coverage result = coverage({1.13, 0.01, 0.03}, 5000, 0.03, 60);  // 5.6 cycles
  CHECK(result.found >= 57);
  CHECK(result.within >= 46);
  CHECK(result.median_standard_error < 0.02);
}

TEST_CASE("noise makes no frequency") {
  // Nominal: 1 in 100. 200 seeds: more than 7 would have a probability of 0.1 % then.
  for (const double memory : {0.0, 0.5, 0.9, 0.99, 1.0, -0.5}) {
    for (const std::size_t samples : {std::size_t{300}, std::size_t{3000}}) {
      int alarms = 0;
      for (std::uint64_t seed = 0; seed < 200; ++seed) {
        traces::Generator generator(seed);
        const auto found = find(
            traces::recording(traces::clock(samples, 1000.0), traces::noise_with_memory(samples, memory, generator)));
        if (found.value_Hz) ++alarms;
        CHECK(found.value_Hz.has_value() == (found.false_alarm_probability <= 0.01));
      }
      CAPTURE(memory, samples);
      CHECK(alarms <= 7);
    }
  }
}

TEST_CASE("a hint does not make noise a frequency") {
  int alarms = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    traces::Generator generator(seed);
    const std::vector<double> force = traces::noise_with_memory(3000, seed % 2 == 0 ? 0.0 : 0.95, generator);
    if (find(traces::recording(traces::clock(3000, 1000.0), force), 20.0).value_Hz) ++alarms;
  }
  CHECK(alarms <= 7);
}
