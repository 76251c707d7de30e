// A stiffness that changes along the path, as that of a line which the drive shortens (docs/model.md (26a)): recordings
// by a simulator that shares no code with the library.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "fit/scene.hpp"
#include "simulator.hpp"
#include "slipfit/sweep.hpp"

using namespace slipfit;

namespace {

// In the middle of the path.
constexpr double kStiffness = 500.0;  // N/m
constexpr double kOmega = 120.0;
constexpr double kDamping = 0.08;

/// Stiffness at a share of the path, over that at the start, of a line with this one at the end.
double growth_at(double share, double ratio) {
  return 1.0 / (1.0 - share * (1.0 - 1.0 / ratio));
}

/// A recording of some 30 slips whose stiffness at the end is this multiple of that at the start.
Recording of_line(double ratio, unsigned seed, double speed_m_per_s = 0.01) {
  constexpr double kStep_s = 1e-3;
  constexpr double kNoise_N = 0.01;
  constexpr double kPath_m = 0.04;
  const auto samples = static_cast<std::size_t>(kPath_m / speed_m_per_s / kStep_s);
  const double start = 1.0 / growth_at(0.5, ratio);
  independent::Model model{};
  model.stiffness = kStiffness * start;
  model.omega = kOmega * std::sqrt(start);
  model.damping_ratio = kDamping / std::sqrt(start);
  if (ratio != 1.0) model.line_length = kPath_m / (1.0 - 1.0 / ratio);
  const std::vector<double> speed(samples, speed_m_per_s), static_N(samples, 2.0), kinetic_N(samples, 1.65);
  const double factor = 1.0;
  const independent::Course course{
      speed.data(), static_N.data(), kinetic_N.data(), &factor, static_cast<long>(samples), 1, kStep_s, 4};
  std::vector<double> force(samples), behind(samples);
  std::vector<independent::Slip> slips(1000);
  independent::simulate(&model, &course, 1.5, force.data(), behind.data(), slips.data(), std::ssize(slips));
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, kNoise_N);
  std::vector<double> time_s;
  for (double& value : force) {
    value += noise(random);
    time_s.push_back(kStep_s * static_cast<double>(time_s.size()));
  }
  Conditions conditions;
  conditions.speed_m_per_s = speed_m_per_s;
  conditions.zero_force_N = 0.0;
  return Recording::create(std::move(time_s), std::move(force), conditions).value();
}

/// 4 standard errors (1 in 16 000 is further off by chance) and a share of the value; known to a fifth.
void check_holds(const FitResult& fit, ParameterId id, double value, double share) {
  CAPTURE(info(id).key);
  const Parameter* const found = fit.find(id);
  REQUIRE(found != nullptr);
  REQUIRE(found->estimate.standard_error);
  CHECK(std::abs(*found->estimate.value - value) < 4.0 * *found->estimate.standard_error + share * value);
  CHECK(*found->estimate.standard_error < 0.2 * value);
}

// ln k of a line is no straight line over the path: k in the middle is as much as this off.
constexpr double kBend = 0.01;

}  // namespace

TEST_CASE("a stiffness that changes along the path is found, and k, w_n and zeta are those in its middle") {
  const double ratio = GENERATE(0.75, 1.1, 1.4);
  CAPTURE(ratio);
  const Analysis analysis = analyze_and_fit(of_line(ratio, 1));
  REQUIRE(analysis.fit);
  // The first slip and what lies before and after the fitted ones are not in it: about a tenth of the path.
  check_holds(*analysis.fit, ParameterId::StiffnessRatio, std::pow(ratio, 0.95), 0.1 * std::abs(std::log(ratio)));
  check_holds(*analysis.fit, ParameterId::Stiffness, kStiffness, kBend);
  check_holds(*analysis.fit, ParameterId::NaturalFrequency, kOmega, kBend);
  check_holds(*analysis.fit, ParameterId::DampingRatio, kDamping, kBend);
}

TEST_CASE("a stiffness that stays the same is not said to change") {
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
    const Analysis analysis = analyze_and_fit(of_line(1.0, seed));
    REQUIRE(analysis.fit);
    CHECK(analysis.fit->find(ParameterId::StiffnessRatio) == nullptr);
  }
}

TEST_CASE("the recordings of a sweep have each their own change of the stiffness and share that in the middle") {
  std::vector<SweepEntry> entries;
  for (const auto& [speed_m_per_s, ratio] : {std::pair{0.006, 1.0}, std::pair{0.01, 1.3}, std::pair{0.018, 0.8}}) {
    entries.push_back({std::to_string(speed_m_per_s), of_line(ratio, 7, speed_m_per_s)});
  }
  const SweepAnalysis sweep = analyze_sweep(entries, {});
  REQUIRE(sweep.fit);
  check_holds(sweep.fit->result, ParameterId::Stiffness, kStiffness, kBend);
  check_holds(sweep.fit->result, ParameterId::NaturalFrequency, kOmega, kBend);
  check_holds(sweep.fit->result, ParameterId::FrictionDifference, 0.35, kBend);
}
