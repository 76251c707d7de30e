#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "analysis/checks.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/pipeline.hpp"

namespace slipfit {
namespace {

constexpr double kRate_Hz = 2000.0;
constexpr double kPeak_N = 4.0;
constexpr double kDrop_N = 2.0;

Conditions conditions_of(std::optional<double> normal_force_N, double speed_m_per_s = 0.01) {
  Conditions conditions;
  conditions.speed_m_per_s = speed_m_per_s;
  conditions.normal_force_N = normal_force_N;
  return conditions;
}

/// Saw-teeth of 0.1 s from scattering peaks, slips of 5 ms, noise; mean near the peak less half a drop.
Recording sawteeth(unsigned seed, const Conditions& conditions) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::normal_distribution<double> scatter(0.0, 0.08);
  std::vector<double> time_s, force;
  double peak = kPeak_N + scatter(random);
  double from = peak - kDrop_N;
  for (int cycle = 0; cycle < 60; ++cycle) {
    for (int i = 0; i < 200; ++i) {
      const double fall = kDrop_N * 0.5 * (1.0 - std::cos(std::numbers::pi * (i - 190) / 10.0));
      const double value = i < 190 ? from + (peak - from) * i / 190.0 : peak - fall;
      time_s.push_back(static_cast<double>(time_s.size()) / kRate_Hz);
      force.push_back(value + noise(random));
    }
    from = peak - kDrop_N;
    peak = kPeak_N + scatter(random);
  }
  auto recording = Recording::create(std::move(time_s), std::move(force), conditions);
  REQUIRE(recording.ok());
  return std::move(recording).value();
}

}  // namespace

TEST_CASE("the intervals of coefficients of friction contain the truth") {
  constexpr double kLoad_N = 10.0;
  constexpr double kMean_N = kPeak_N - 0.5 * kDrop_N;
  int of_peaks = 0;
  int of_mean = 0;
  constexpr int kRecordings = 40;
  for (unsigned seed = 1; seed <= kRecordings; ++seed) {
    const Analysis analysis = analyze(sawteeth(seed, conditions_of(kLoad_N)));
    REQUIRE(analysis.coefficients);
    of_peaks += holds(analysis.coefficients->static_mean_peak, kPeak_N / kLoad_N) ? 1 : 0;
    of_mean += holds(analysis.coefficients->kinetic_mean, kMean_N / kLoad_N) ? 1 : 0;
  }
  CHECK(of_peaks >= 35);  // below it one in 100 times where the interval holds 95 of 100
  CHECK(of_mean >= 35);
}

TEST_CASE("thirds, scatter and the requirements of the standards accompany the coefficients") {
  constexpr double kLoad_N = 1.96;
  const double standard_speed = 0.150 / 60.0;  // of ASTM D1894: 6 s are 15 mm
  const auto coefficients = analyze(sawteeth(3, conditions_of(kLoad_N, standard_speed))).coefficients;
  REQUIRE(coefficients);
  const double mean = *coefficients->kinetic_mean.value;
  CHECK(*coefficients->kinetic_first_third.value == Approx(mean).epsilon(0.05));
  CHECK(*coefficients->kinetic_last_third.value == Approx(mean).epsilon(0.05));
  CHECK(*coefficients->kinetic_sd == Approx(kDrop_N / std::sqrt(12.0) / kLoad_N).epsilon(0.1));
  CHECK(*coefficients->static_peak_sd == Approx(0.08 / kLoad_N).epsilon(0.4));
  REQUIRE(coefficients->standards.size() == 2);
  const StandardCoefficients& astm = coefficients->standards[0];
  CHECK(astm.standard == "ASTM D1894");
  REQUIRE(astm.differs.size() == 2);
  CHECK(astm.differs[0].starts_with("sliding distance 15 mm of 130"));
  CHECK(astm.differs[1].starts_with("during stick-slip"));
  CHECK(*astm.kinetic_coefficient.value == Approx(mean));
  CHECK(coefficients->standards[1].differs[0] == "driven at 150 mm/min, not 100");
}

TEST_CASE("of a longer path the standards take its beginning") {
  std::vector<double> time_s, force;
  for (int i = 0; i < 12000; ++i) {  // 200 mm; friction falls from 1.2 N to 0.8 N behind 100 mm
    time_s.push_back(0.01 * i);
    force.push_back((i < 6000 ? 1.2 : 0.8) + 0.01 * std::sin(12.9898 * i));
  }
  auto recording = Recording::create(std::move(time_s), std::move(force), conditions_of(2.0, 0.100 / 60.0));
  REQUIRE(recording.ok());
  const auto coefficients = analyze(recording.value()).coefficients;
  REQUIRE(coefficients);
  CHECK(*coefficients->standards[1].kinetic_coefficient.value == Approx(0.6).epsilon(0.01));
  CHECK(*coefficients->standards[0].kinetic_coefficient.value == Approx((100 * 0.6 + 30 * 0.4) / 130).epsilon(0.01));
}

TEST_CASE("without a load there are no coefficients, and of a column of coefficients they are those") {
  CHECK_FALSE(analyze(sawteeth(1, conditions_of(std::nullopt))).coefficients);
  Conditions conditions = conditions_of(std::nullopt);
  conditions.quantity = ForceQuantity::FrictionCoefficient;
  const auto coefficients = analyze(sawteeth(1, conditions)).coefficients;
  REQUIRE(coefficients);
  CHECK(*coefficients->static_mean_peak.value == Approx(kPeak_N).epsilon(0.02));
}

TEST_CASE("a speed that is a thousand times too high is asked about") {
  CHECK_FALSE(warns(analyze(sawteeth(1, conditions_of(5.0))), "implausible_units"));
  const Analysis analysis = analyze(sawteeth(1, conditions_of(5.0, 10.0)));
  REQUIRE(warns(analysis, "implausible_units"));
  CHECK(analysis.warnings.back().message.find("is the speed in mm/s") != std::string::npos);
}

}  // namespace slipfit
