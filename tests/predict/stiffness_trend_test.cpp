// Stiffness that goes with the driving speed: what is predicted from it, and what a sweep tells of it.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "differences.hpp"
#include "slipfit/predict/prediction.hpp"
#include "slipfit/sweep.hpp"
#include "speed_sweep.hpp"

using namespace slipfit;
using test::predicted;

namespace {

PredictionModel trend_example(double exponent) {
  PredictionModel model;
  model.estimate = {350.0, 26.0, 0.03, 0.14, {}, 1e9, true};
  model.estimate.stiffness_trend = StiffnessTrend{exponent, 0.002};
  test::set_errors(model, {0.01, 0.01, 0.005, 0.02, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.01});
  return model;
}

PredictionModel ageing_trend_example(double exponent) {
  PredictionModel model = trend_example(exponent);
  model.estimate.ageing = Ageing{0.03, 0.5};
  model.estimate.reloading = Reloading{0.04, 1.5e-4};
  return model;
}

/// Of one mass, with k at 0.04 m/s.
test::SpeedSweep slider_at(double exponent, double speed_m_per_s) {
  test::SpeedSweep slider;
  const double growth = std::pow(speed_m_per_s / 0.04, exponent);
  slider.f0_N = 4.0;
  slider.f1_N = 0.0;
  slider.stiffness_N_per_m *= growth;
  slider.omega_rad_per_s *= std::sqrt(growth);
  return slider;
}

std::vector<SweepEntry> recorded(double exponent, std::uint64_t seed) {
  std::vector<SweepEntry> entries;
  for (const double speed : {0.01, 0.02, 0.04, 0.08, 0.16}) {
    entries.push_back(test::record(slider_at(exponent, speed), speed, ++seed));
    entries.back().id = std::to_string(speed);
  }
  return entries;
}

}  // namespace

TEST_CASE("stiffness trend: the motion at a speed is that of the stiffness there, with the same mass") {
  const double exponent = GENERATE(-0.1, 0.07);
  for (const double speed : {0.0005, 0.002, 0.004}) {
    const PredictionModel model = GENERATE_COPY(trend_example(exponent), ageing_trend_example(exponent));
    PredictionModel there = model;
    const double growth = std::pow(speed / 0.002, exponent);
    there.estimate.stiffness_N_per_m *= growth;
    there.estimate.natural_frequency_rad_per_s *= std::sqrt(growth);
    there.estimate.stiffness_trend.reset();
    CAPTURE(exponent, speed);
    REQUIRE(predicted(there, speed).period_s.value);
    REQUIRE(predicted(model, speed).period_s.value);
    CHECK(*predicted(model, speed).period_s.value == Approx(*predicted(there, speed).period_s.value).epsilon(1e-14));
    CHECK(*predicted(model, speed).lambda.value == Approx(*predicted(there, speed).lambda.value).epsilon(1e-14));
  }
}

TEST_CASE("stiffness trend: intervals follow from derivatives that agree with differences") {
  const PredictionModel model = GENERATE(trend_example(0.07), trend_example(-0.1), ageing_trend_example(0.07));
  // The slope of the iteration is that of its last steps, which rounding of 1e-14 leaves uncertain by 1e-3 of itself.
  test::check_intervals(model, 1e-4);
}

TEST_CASE("stiffness trend: the band of a sweep holds at the speed that k belongs to, and grows beyond its speeds") {
  PredictionModel model = trend_example(0.07);
  model.estimate.reach = SpeedReach{0.0005, 0.0021, 0.1};
  const auto relative = [&](double speed) {
    const Estimate period = predicted(model, speed).period_s;
    REQUIRE(period.ci95);
    return period.ci95->high / *period.value;
  };
  CHECK(std::isfinite(relative(0.001)));
  CHECK(relative(0.002) == Approx(relative(0.002 * (1.0 + 1e-9))).epsilon(1e-6));
  CHECK(relative(0.004) > relative(0.002));
}

TEST_CASE("stiffness trend: a sweep tells it, and predicts spacings by it") {
  const double exponent = GENERATE(-0.06, 0.06);
  const SweepAnalysis sweep = analyze_sweep(recorded(exponent, 100));
  REQUIRE(sweep.fit);
  REQUIRE(sweep.fit->result.estimate);
  const Estimate found = sweep.fit->result.estimate_of(ParameterId::StiffnessExponent);
  REQUIRE(found.ci95);
  CAPTURE(exponent, found.ci95->low, found.ci95->high);
  CHECK(std::abs(*found.value - exponent) < 2.0 * *found.standard_error + 1e-4);
  const PredictionModel model{*sweep.fit->result.estimate, true, std::nullopt};
  for (const double speed : {0.014, 0.11, 0.3}) {
    const double expected = test::spacing_m(slider_at(exponent, speed), speed);
    CHECK(*predicted(model, speed).periodic_displacement_m.value == Approx(expected).epsilon(0.01));
  }
}

TEST_CASE("stiffness trend: none is found where the stiffness is the same at every speed") {
  for (std::uint64_t seed = 200; seed < 205; ++seed) {
    const SweepAnalysis sweep = analyze_sweep(recorded(0.0, 10 * seed));
    REQUIRE(sweep.fit);
    CHECK(sweep.fit->result.find(ParameterId::StiffnessExponent) == nullptr);
  }
}
