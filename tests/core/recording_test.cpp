#include "slipfit/core/recording.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

using slipfit::Recording;

namespace {

Recording with_steps(const std::vector<double>& steps_s) {
  std::vector<double> time_s{0.0};
  for (const double step_s : steps_s) time_s.push_back(time_s.back() + step_s);
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = 0.01;
  std::vector<double> force(time_s.size(), 1.0);
  return Recording::create(std::move(time_s), std::move(force), conditions).value();
}

/// By sorting, of the steps that the clock's own rounding left.
double sorted_median_step(const Recording& recording) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < recording.size(); ++i) {
    const double step_s = recording.time_s()[i] - recording.time_s()[i - 1];
    if (step_s > 0.0) steps_s.push_back(step_s);
  }
  std::sort(steps_s.begin(), steps_s.end());
  return steps_s[steps_s.size() / 2];
}

}  // namespace

TEST_CASE("the sample interval is the median of the steps that are not nought, whatever the clock") {
  std::mt19937_64 random(1);  // NOLINT: the same numbers each time
  for (const std::size_t count : {1U, 2U, 3U, 15U, 16U, 17U, 18U, 100U, 1001U}) {
    std::vector<double> jittered;
    std::vector<double> two_valued;
    std::vector<double> misleading;  // every 16th step is not like the others
    for (std::size_t i = 0; i < count; ++i) {
      const double share = std::generate_canonical<double, 53>(random);
      jittered.push_back(0.5 + share);
      two_valued.push_back(share < 0.5 ? 1.0 : 2.0);
      misleading.push_back(i % 16 == 0 ? 8.0 : i % 16 < 6 ? 0.0 : 1.0);
    }
    for (const auto& steps_s : {jittered, two_valued, misleading}) {
      const Recording recording = with_steps(steps_s);
      CHECK(recording.sample_interval_s() == sorted_median_step(recording));
    }
  }
  CHECK(with_steps({0.0, 0.0, 3.0}).sample_interval_s() == 3.0);
}

TEST_CASE("a clock is even as long as no stamp is a quarter of a step off") {
  CHECK(with_steps(std::vector<double>(1000, 0.001)).clock_is_even());
  std::vector<double> steps_s(1000, 0.001);
  steps_s[500] += 0.2e-3;
  steps_s[501] -= 0.2e-3;
  CHECK(with_steps(steps_s).clock_is_even());
  steps_s[500] += 0.1e-3;
  steps_s[501] -= 0.1e-3;
  CHECK_FALSE(with_steps(steps_s).clock_is_even());
}
