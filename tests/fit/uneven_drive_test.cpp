#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "scene.hpp"
#include "support/recordings.hpp"

namespace slipfit {
namespace {

constexpr double kSpeedShare = 0.15;

/// What a drive shows whose speed is V (1 + kSpeedShare cos w t): the same force, at the time at which an even drive
/// has come as far. That is exact in stick; slips, which are short, last a little longer or shorter.
Recording on_uneven_drive(const Recording& even, double frequency_Hz) {
  const double omega = 2.0 * std::numbers::pi * frequency_Hz;
  std::vector<double> force;
  for (const double t_s : even.time_s()) {
    const double even_s = t_s + kSpeedShare / omega * std::sin(omega * t_s);
    const double place = std::clamp(even_s / even.sample_interval_s(), 0.0, static_cast<double>(even.size()) - 1.001);
    const auto below = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(below);
    force.push_back((1.0 - share) * even.force()[below] + share * even.force()[below + 1]);
  }
  return test::with_force(even, std::move(force));
}

Scene scene() {
  return {.speed = 0.003, .samples_per_slip = 40.0, .noise = 0.005};
}

}  // namespace

TEST_CASE("a drive that runs unevenly is said, and its line is fitted with the cycles") {
  const Recording even = record(scene());
  const Analysis plain = analyze_and_fit(even);
  CHECK_FALSE(has_warning(plain, "drive_ripple"));
  const double slips_Hz = *plain.frequency.quoted.value;
  const double ratio = GENERATE(4.37, 5.0);  // the second is in step: part of the shape of the cycles
  const Analysis analysis = analyze_and_fit(on_uneven_drive(even, ratio * slips_Hz));
  INFO(ratio);
  CHECK(has_warning(analysis, "drive_ripple") == (ratio != 5.0));
  CHECK(has_warning(analysis, "hum_fitted") == (ratio != 5.0));
  const Parameter& stiffness = parameter(analysis, "stiffness_N_per_m");
  REQUIRE(stiffness.estimate.ci95);
  CHECK(stiffness.estimate.ci95->low < scene().stiffness);
  CHECK(stiffness.estimate.ci95->high > scene().stiffness);
  CHECK(parameter(analysis, "natural_frequency_rad_per_s").status != ParameterStatus::Identified);
}

TEST_CASE("sticks that flatten at both ends are curved, though their halves are alike") {
  const Scene s{.jitter = 0.02, .noise = 0.01};
  const Recording straight = record(s);
  const double difference = s.static_N - s.kinetic_N;
  std::vector<double> force;
  for (const double f : straight.force()) {
    const double u = (f - s.kinetic_N) / difference;
    force.push_back(f - 0.05 * difference * std::pow(u, 5));  // the slope falls by a quarter towards either end
  }
  const Parameter& k = parameter(analyze_and_fit(test::with_force(straight, force)), "stiffness_N_per_m");
  CHECK(k.status != ParameterStatus::Identified);
  CHECK_THAT(k.estimate.note, Catch::Contains("over their second half"));
}

}  // namespace slipfit
