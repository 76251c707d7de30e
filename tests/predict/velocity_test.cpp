// Predictions with friction that depends on the sliding speed: against reference values, Coulomb friction, differences.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "differences.hpp"
#include "model/reference_table.hpp"
#include "slipfit/predict/prediction.hpp"

using namespace slipfit;
using test::predicted;

namespace {

PredictionModel velocity_example() {
  PredictionModel model;
  model.estimate = {1000.0, 200.0, 0.08, 2.0, {}, 1e9, true, SpeedDependence{-4.0, -8.0}};
  test::set_errors(model, {0.002, 0.003, 0.002, 0.008, 0.1, 0.3});
  model.kinetic_friction_N = Estimate{4.0, 0.0, {}, {}};
  return model;
}

const std::array<Estimate PredictedMotion::*, 8> kQuantities{
    &PredictedMotion::period_s,     &PredictedMotion::frequency_Hz,    &PredictedMotion::slip_time_s,
    &PredictedMotion::stick_time_s, &PredictedMotion::sticking_degree, &PredictedMotion::periodic_displacement_m,
    &PredictedMotion::force_peak_N, &PredictedMotion::force_trough_N};

}  // namespace

TEST_CASE("with velocity-dependent friction a prediction is the motion that an independent program integrates") {
  for (const auto& row : test::reference_rows("velocity_dependent.csv")) {
    const double onset = row.at("phi0") + row.at("phi1");
    PredictionModel model;  // k = w_n = V = 1
    model.estimate = {1.0, 1.0, row.at("zeta"), row.at("phi_s") - onset,
                      {},  1.0, true,           SpeedDependence{row.at("phi1") * row.at("a"), row.at("a")}};
    model.kinetic_friction_N = Estimate{onset, {}, {}, {}};
    const PredictedMotion motion = predicted(model, 1.0);
    CAPTURE(row.at("zeta"), row.at("phi_s"), row.at("a"));
    CHECK(motion.period_s.value.has_value() == (row.at("sticks") == 1.0));
    if (row.at("sticks") != 1.0) continue;
    // The slip is integrated to 1e-9 and read off quintic polynomials: 4e-7 of the motion.
    CHECK(*motion.slip_time_s.value == Approx(row.at("slip_time")).epsilon(2e-6));
    CHECK(*motion.stick_time_s.value == Approx(row.at("stick_time")).epsilon(2e-6));
    CHECK(*motion.sticking_degree.value == Approx(row.at("sticking_degree")).epsilon(2e-6));
    CHECK(*motion.periodic_displacement_m.value == Approx(row.at("xi")).epsilon(2e-6));
    CHECK_FALSE(motion.period_s.ci95);
  }
}

TEST_CASE("friction that does not change with the speed is Coulomb friction: values, intervals, critical speed") {
  PredictionModel coulomb = velocity_example();
  coulomb.estimate.speed_dependence.reset();
  for (auto& row : coulomb.estimate.covariance) row[4] = row[5] = 0.0;
  coulomb.estimate.covariance[4] = coulomb.estimate.covariance[5] = {};
  PredictionModel level = coulomb;
  level.estimate.speed_dependence = SpeedDependence{0.0, 0.0};
  const std::vector<double> speeds{0.001, 0.02, 0.1, 0.25, 0.33, 0.34, 0.36, 1.0};
  const Prediction exact = predict_at(coulomb, speeds);
  const Prediction same = predict_at(level, speeds);
  const auto check_same = [](const Estimate& a, const Estimate& b) {
    REQUIRE(a.value.has_value() == b.value.has_value());
    REQUIRE(a.ci95.has_value() == b.ci95.has_value());
    if (a.value) CHECK(*b.value == Approx(*a.value).epsilon(1e-6));
    if (a.ci95) CHECK(b.ci95->low == Approx(a.ci95->low).epsilon(1e-5));
    if (a.ci95) CHECK(b.ci95->high == Approx(a.ci95->high).epsilon(1e-5));
  };
  check_same(exact.critical_speed_m_per_s, same.critical_speed_m_per_s);
  check_same(exact.lambda_critical, same.lambda_critical);
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    CAPTURE(speeds[i]);
    CHECK(exact.rows[i].regime == same.rows[i].regime);
    CHECK(exact.rows[i].note == same.rows[i].note);
    for (const auto quantity : kQuantities) check_same(exact.rows[i].*quantity, same.rows[i].*quantity);
  }
  CHECK_FALSE(exact.rows[4].note.empty());  // the doubt around the critical speed is among what is compared
  CHECK(exact.rows[3].note.empty());
}

TEST_CASE("standard errors with velocity-dependent friction agree with central differences") {
  const PredictionModel model = velocity_example();
  for (const double speed : {0.005, 0.05, 0.2, 0.4}) {
    const PredictedMotion row = predicted(model, speed);
    for (const auto quantity : kQuantities) {
      const double expected = test::standard_error_by_differences(
          model, 1e-4, [&](const PredictionModel& at) { return *(predicted(at, speed).*quantity).value; });
      CAPTURE(speed, quantity == kQuantities[2], expected);
      CHECK(*(row.*quantity).standard_error == Approx(expected).epsilon(2e-3));
    }
  }
  const Prediction prediction = predict_at(model, std::vector<double>{});
  const double expected = test::standard_error_by_differences(
      model, 1e-4, [](const PredictionModel& at) { return *test::critical_speed(at).value; });
  CHECK(*prediction.critical_speed_m_per_s.standard_error == Approx(expected).epsilon(1e-3));
}

TEST_CASE("stick-slip ends at the critical speed, with velocity-dependent friction too") {
  for (const SpeedDependence law :
       {SpeedDependence{-4.0, -8.0}, SpeedDependence{0.5, 2.0}, SpeedDependence{2.0, -3.0}}) {
    PredictionModel model = velocity_example();
    model.has_covariance = false;
    model.estimate.speed_dependence = law;
    const double critical = *test::critical_speed(model).value;
    CAPTURE(law.slope_N_s_per_m, law.alpha_s_per_m, critical);
    CHECK(predicted(model, critical * (1.0 - 1e-9)).period_s.value);
    for (const double above : {1.0 + 1e-9, 1.1, 3.0}) CHECK_FALSE(predicted(model, critical * above).period_s.value);
  }
}

TEST_CASE("the regime follows the damping of steady sliding and whether the slip sticks") {
  PredictionModel model = velocity_example();
  // zeta + slope at V / (2 sqrt(k m)) = 0.08 - 0.4 exp(-8 V) passes 0 at V = ln(5) / 8 = 0.2012 m/s.
  CHECK(predicted(model, 0.19).regime == Regime::StickSlip);
  CHECK(predicted(model, 0.22).regime == Regime::StickSlipBistable);
  CHECK(predicted(model, 2.0).regime == Regime::OscillatorySlip);
  model.estimate.speed_dependence = SpeedDependence{20.0, 0.1};  // total damping above 1
  CHECK(predicted(model, 0.5).regime == Regime::ContinuousSlip);
  // F_k falls by far more than F_s - F_k: the mass is thrown beyond the drive, and the next slip starts before a stick.
  model.estimate.speed_dependence = SpeedDependence{-12.0, 0.4};
  CHECK(predicted(model, 2.0).regime == Regime::UnstableSteady);
  CHECK_FALSE(predicted(model, 2.0).period_s.value);
}

TEST_CASE("a row says where the data cannot tell whether steady sliding is stable, and keeps its bands") {
  const PredictedMotion row = predicted(velocity_example(), 0.2012);
  CHECK_THAT(row.note, Catch::Contains("steady sliding is stable"));
  CHECK(row.period_s.ci95);
  CHECK(predicted(velocity_example(), 0.1).note.empty());
}

TEST_CASE("bands hold 95 % of the motions that the covariance allows where alpha itself is hardly known") {
  PredictionModel model = velocity_example();
  auto& covariance = model.estimate.covariance;
  for (auto& row : covariance) row.fill(0.0);
  const std::array<double, 4> se{0.002, 0.003, 0.003, 0.01};
  for (std::size_t i = 0; i < se.size(); ++i) covariance[i][i] = se[i] * se[i];
  // What a sweep knows of the law: the mean slope over a slip (fastest at v_c) well, alpha = -8 +- 4 badly, apart from
  // each other; the slope at v = 0 follows from both.
  const double v_c = 0.4;
  const auto over_mean = [v_c](double alpha) { return alpha * v_c / std::expm1(alpha * v_c); };
  const double mean_slope = -4.0 / over_mean(-8.0);
  const double mean_slope_se = 0.05 * std::abs(mean_slope);
  const double alpha_se = 4.0;
  const double by_alpha = mean_slope * (over_mean(-8.0 + 1e-6) - over_mean(-8.0 - 1e-6)) / 2e-6;
  covariance[4][4] = std::pow(over_mean(-8.0) * mean_slope_se, 2) + std::pow(by_alpha * alpha_se, 2);
  covariance[5][5] = alpha_se * alpha_se;
  covariance[4][5] = covariance[5][4] = by_alpha * alpha_se * alpha_se;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const double speed : {0.01, 0.05, 0.085}) {
    const PredictedMotion row = predicted(model, speed);
    REQUIRE(row.period_s.ci95);
    int inside = 0;
    constexpr int kDraws = 400;
    for (int draw = 0; draw < kDraws; ++draw) {
      PredictionModel other = model;
      other.has_covariance = false;
      for (std::size_t i = 0; i < se.size(); ++i) other = test::moved(other, i, se[i] * normal(random));
      const double alpha = -8.0 + alpha_se * normal(random);
      other.estimate.speed_dependence =
          SpeedDependence{(mean_slope + mean_slope_se * normal(random)) * over_mean(alpha), alpha};
      const std::optional<double> period = predicted(other, speed).period_s.value;
      inside += period && *period >= row.period_s.ci95->low && *period <= row.period_s.ci95->high ? 1 : 0;
    }
    CAPTURE(speed, inside);
    CHECK(inside > 364);  // 380 expected, 3.6 standard deviations of 4.4 fewer
  }
  const PredictedMotion beyond = predicted(model, 0.1);
  CHECK(beyond.period_s.value);
  CHECK_FALSE(beyond.period_s.ci95);
  CHECK_THAT(beyond.note, Catch::Contains("alpha is not known"));
}
