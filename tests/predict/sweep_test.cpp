// Fits of sweeps of simulated sweeps: what they predict at speeds that were not measured.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "slipfit/predict/prediction.hpp"
#include "slipfit/sweep.hpp"
#include "speed_sweep.hpp"

using namespace slipfit;

namespace {

const Parameter& parameter(const SweepAnalysis& sweep, const std::string& name) {
  const auto& all = sweep.fit->result.parameters;
  const auto found = std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.name() == name; });
  REQUIRE(found != all.end());
  return *found;
}

PredictionModel model_of(const SweepAnalysis& sweep) {
  REQUIRE(sweep.fit);
  REQUIRE(sweep.fit->result.estimate);
  PredictionModel model;
  model.estimate = *sweep.fit->result.estimate;
  model.has_covariance = true;
  return model;
}

bool holds(const Estimate& estimate, double truth) {
  return estimate.ci95 && estimate.ci95->low <= truth && truth <= estimate.ci95->high;
}

}  // namespace

TEST_CASE("a sweep of three speeds predicts the spacing at twice and four times the fastest of them") {
  int inside = 0;
  int all = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const double alpha : {-8.0, -3.0, 1.0}) {
      test::SpeedSweep truth;
      truth.alpha_s_per_m = alpha;
      const SweepAnalysis sweep = analyze_sweep(test::record(truth, {0.01, 0.02, 0.04}, 100 * seed), {});
      const PredictionModel model = model_of(sweep);
      CHECK(model.estimate.speed_dependence);
      for (const double speed : {0.08, 0.16}) {
        const std::vector<double> speeds{speed};
        const Estimate spacing = predict_at(model, speeds).rows[0].periodic_displacement_m;
        const double expected = test::spacing_m(truth, speed);
        CAPTURE(seed, alpha, speed, expected);
        REQUIRE(spacing.value);
        CHECK(*spacing.value == Approx(expected).epsilon(0.02));
        inside += holds(spacing, expected) ? 1 : 0;
        ++all;
      }
    }
  }
  CAPTURE(inside, all);
  CHECK(inside >= 25);  // of 30 at 95 %: fewer by chance once in 200, pairs of speeds going together
}

TEST_CASE("a fit of a sweep carries slope and alpha, and where stick-slip ends") {
  const test::SpeedSweep truth;
  const SweepAnalysis sweep = analyze_sweep(test::record(truth, {0.01, 0.03, 0.1, 0.2}, 7), {});
  const ModelEstimate& estimate = model_of(sweep).estimate;
  REQUIRE(estimate.speed_dependence);
  CHECK(holds(parameter(sweep, "friction_slope_N_s_per_m").estimate, truth.f1_N * truth.alpha_s_per_m));
  CHECK(estimate.covariance[4][4] > 0.0);
  CHECK(estimate.covariance[5][5] > 0.0);
  const Correlation& correlation = *sweep.fit->result.correlation;
  CHECK(correlation.names.size() == 6);
  REQUIRE(sweep.derived.critical_speed_m_per_s.ci95);
  CHECK_FALSE(sweep.derived.lambda.value);
  CHECK_FALSE(sweep.derived.lambda.note.empty());
  // V_c of the truth by bisection of the test's own integration: the spacing jumps where the first swing stops
  // sticking.
  const double period_of_swing = 2.0 * M_PI / truth.omega_rad_per_s;
  double low = 0.05;
  double high = 2.0;
  while (high - low > 1e-5) {
    const double middle = 0.5 * (low + high);
    (test::slip_s(truth, middle) < 1.2 * period_of_swing ? low : high) = middle;
  }
  CAPTURE(low, *sweep.derived.critical_speed_m_per_s.value);
  CHECK(holds(sweep.derived.critical_speed_m_per_s, low));
}

TEST_CASE("the spacing that the other recordings predict for one left out holds the truth") {
  test::SpeedSweep truth;
  int inside = 0;
  int all = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const std::vector<SweepEntry> entries = test::record(truth, {0.01, 0.02, 0.04, 0.08, 0.16}, 1000 * seed);
    const SweepAnalysis sweep = analyze_sweep(entries, {});
    REQUIRE(sweep.fit);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const Estimate& spacing = sweep.fit->points[i].spacing_left_out_m;
      const double expected = test::spacing_m(truth, entries[i].recording.conditions().speed_m_per_s);
      CAPTURE(seed, i, expected, *spacing.value);
      CHECK(std::abs(*spacing.value - expected) < 5.0 * *spacing.standard_error);
      inside += holds(spacing, expected) ? 1 : 0;
      ++all;
    }
  }
  CAPTURE(inside, all);
  CHECK(inside >= 16);  // of 20
}

TEST_CASE("recordings at one speed cannot tell alpha: it is refused, with the reason") {
  const SweepAnalysis sweep = analyze_sweep(test::record({}, {0.02, 0.02, 0.02}, 11), {});
  REQUIRE(sweep.fit);
  const Parameter& alpha = parameter(sweep, "alpha_s_per_m");
  CHECK(alpha.status == ParameterStatus::Unidentified);
  CHECK_FALSE(alpha.estimate.value);
  CHECK_THAT(alpha.estimate.note, Catch::Contains("one speed cannot tell alpha"));
  CHECK_FALSE(sweep.fit->result.estimate->speed_dependence);
}

TEST_CASE("a sweep under Coulomb friction is predicted by Coulomb friction") {
  test::SpeedSweep truth;
  truth.f0_N = 4.0;
  truth.f1_N = 0.0;
  const SweepAnalysis sweep = analyze_sweep(test::record(truth, {0.01, 0.02, 0.04}, 21), {});
  REQUIRE(sweep.fit);
  CHECK(sweep.fit->result.tier == Tier::Damped);
  CHECK(parameter(sweep, "alpha_s_per_m").status == ParameterStatus::Unidentified);
  const PredictionModel model = model_of(sweep);
  CHECK_FALSE(model.estimate.speed_dependence);
  const std::vector<double> speeds{0.1};
  const Estimate spacing = predict_at(model, speeds).rows[0].periodic_displacement_m;
  CHECK(std::abs(*spacing.value - test::spacing_m(truth, 0.1)) < 4.0 * *spacing.standard_error);
}

TEST_CASE("where a sweep's fit does not tell the end of stick-slip, its runs do") {
  const FitResult no_fit;
  const Derived between = derive_from_sweep(no_fit, {0.004, 0.007});
  CHECK(between.critical_speed_m_per_s.ci95->low == 0.004);
  CHECK(between.critical_speed_m_per_s.ci95->high == 0.007);
  CHECK_THAT(between.critical_speed_m_per_s.note, Catch::Contains("by the runs"));
  CHECK(*between.observed_end->sticks_m_per_s == 0.004);
  const Derived above = derive_from_sweep(no_fit, {0.004, {}});
  CHECK_FALSE(above.critical_speed_m_per_s.value);
  CHECK_THAT(above.critical_speed_m_per_s.note, Catch::Contains("above 0.004 m/s"));
  const Derived none = derive_from_sweep(no_fit, {});
  CHECK_FALSE(none.critical_speed_m_per_s.value);
  CHECK_FALSE(none.critical_speed_m_per_s.note.empty());
}

TEST_CASE("a fit that ends stick-slip below a run that sticks is not believed") {
  test::SpeedSweep truth;
  truth.f0_N = 4.0;
  truth.f1_N = 0.0;
  const SweepAnalysis sweep = analyze_sweep(test::record(truth, {0.01, 0.02, 0.04}, 21), {});
  REQUIRE(sweep.fit);
  const Estimate by_fit = derive_from_sweep(sweep.fit->result, {0.04, {}}).critical_speed_m_per_s;
  REQUIRE(by_fit.value);
  const double faster = 10.0 * by_fit.ci95->high;
  CHECK_FALSE(derive_from_sweep(sweep.fit->result, {faster, {}}).critical_speed_m_per_s.value);
  CHECK(derive_from_sweep(sweep.fit->result, {faster, 2.0 * faster}).critical_speed_m_per_s.ci95->low == faster);
}
