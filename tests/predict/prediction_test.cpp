#include "slipfit/predict/prediction.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "differences.hpp"
#include "slipfit/predict/derived.hpp"
#include "slipfit/predict/single_speed.hpp"
#include "slipfit/predict/speeds.hpp"

using namespace slipfit;
using test::predicted;

namespace {

constexpr double kQuantile = 1.959963984540054;  // of the normal distribution, 97.5 %

/// zeta 0.05, V_c = 0.439 m/s.
PredictionModel coulomb_example() {
  PredictionModel model;
  model.estimate.stiffness_N_per_m = 1000.0;
  model.estimate.natural_frequency_rad_per_s = 200.0;
  model.estimate.damping_ratio = 0.05;
  model.estimate.friction_difference_N = 2.0;
  test::set_errors(model, {0.002, 0.003, 0.0015, 0.008});
  model.estimate.degrees_of_freedom = 1e9;
  model.estimate.damping_identified = true;
  model.kinetic_friction_N = Estimate{4.0, 0.01, {}, {}};
  return model;
}

struct Compared {
  Estimate PredictedMotion::*predicted;
  double LimitCycle::*exact;
};

const std::array<Compared, 7> kCompared{
    {{&PredictedMotion::period_s, &LimitCycle::period_s},
     {&PredictedMotion::slip_time_s, &LimitCycle::slip_s},
     {&PredictedMotion::stick_time_s, &LimitCycle::stick_s},
     {&PredictedMotion::sticking_degree, &LimitCycle::sticking_degree},
     {&PredictedMotion::periodic_displacement_m, &LimitCycle::periodic_displacement_m},
     {&PredictedMotion::force_peak_N, &LimitCycle::force_peak_N},
     {&PredictedMotion::force_trough_N, &LimitCycle::force_trough_N}}};

}  // namespace

TEST_CASE("a prediction is the exact motion, for random parameters and speeds") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int run = 0; run < 200; ++run) {
    CAPTURE(run);
    const Slider slider = Slider::create(std::exp(4.0 + 8.0 * unit(random)), std::exp(3.0 + 5.0 * unit(random)),
                                         0.4 * unit(random) * unit(random))
                              .value();
    const double kinetic_N = 3.0 * unit(random);
    const Friction friction = Friction::create(kinetic_N + 0.1 + unit(random), kinetic_N).value();
    const double lambda = std::exp(-1.0 + 9.0 * unit(random));
    const double speed =
        slider.natural_frequency_rad_per_s() * friction.difference_N() / (slider.stiffness_N_per_m() * lambda);
    const Motion exact = damped_motion(slider, friction, speed);
    const PredictedMotion row = predicted(stated_model(slider, friction), speed);
    CHECK(*row.lambda.value == Approx(exact.lambda).epsilon(1e-12));
    CHECK_FALSE(row.lambda.ci95);
    CHECK(row.note.empty());
    for (const Compared& compared : kCompared) {
      CHECK((row.*compared.predicted).value.has_value() == exact.cycle.has_value());
      CHECK_FALSE((row.*compared.predicted).ci95);
      if (!exact.cycle) continue;
      CHECK(*(row.*compared.predicted).value == Approx((*exact.cycle).*compared.exact).epsilon(1e-10).margin(1e-14));
    }
    CHECK(row.frequency_Hz.value.has_value() == exact.cycle.has_value());
    if (exact.cycle) CHECK(*row.frequency_Hz.value == Approx(1.0 / exact.cycle->period_s).epsilon(1e-10));
  }
}

TEST_CASE("standard errors of a prediction agree with differences") {
  PredictionModel model = coulomb_example();
  model.kinetic_friction_N->standard_error = 0.0;
  for (const double speed : {0.001, 0.02, 0.1, 0.3}) {
    const PredictedMotion row = predicted(model, speed);
    for (const Compared& compared : kCompared) {
      const double expected = test::standard_error_by_differences(
          model, 1e-3, [&](const PredictionModel& at) { return *(predicted(at, speed).*compared.predicted).value; });
      CAPTURE(speed, expected);
      CHECK(*(row.*compared.predicted).standard_error == Approx(expected).epsilon(1e-5));
    }
  }
}

TEST_CASE("intervals are symmetric in the logarithm, and a sticking degree stays between 0 and 1") {
  PredictionModel model = coulomb_example();
  const PredictedMotion row = predicted(model, 0.02);
  const Estimate& period = row.period_s;
  CHECK(period.ci95->low * period.ci95->high == Approx(*period.value * *period.value));
  CHECK(std::log(period.ci95->high / *period.value) == Approx(kQuantile * *period.standard_error / *period.value));
  CHECK(row.frequency_Hz.ci95->low == Approx(1.0 / period.ci95->high));
  for (auto& line : model.estimate.covariance) {
    for (double& cell : line) cell *= 1e4;
  }
  model.estimate.damping_identified = false;
  const Interval sticking = *predicted(model, 1e-4).sticking_degree.ci95;
  CHECK(sticking.low > 0.0);
  CHECK(sticking.high < 1.0);
}

TEST_CASE("a measured spacing is held against the predicted one in units of its 95 % reach") {
  FitResult fit;
  fit.estimate = coulomb_example().estimate;
  Conditions conditions;
  conditions.speed_m_per_s = 0.03;
  const auto score_at = [&](double measured_m) {
    conditions.measured_spacing_m = measured_m;
    return *derive_from_model(fit, conditions).measured_spacing_En;
  };
  CHECK_FALSE(derive_from_model(fit, conditions).measured_spacing_En);
  const Estimate predicted = derive_from_model(fit, conditions).periodic_displacement_m;
  CHECK(*score_at(predicted.ci95->low).value == Approx(1.0));
  CHECK(*score_at(predicted.ci95->high).value == Approx(-1.0));
  CHECK(*score_at(*predicted.value).value == 0.0);
  CHECK(*score_at(0.5 * *predicted.value).value > 2.0);
  CHECK_FALSE(score_at(*predicted.value).note.empty());
  fit.estimate.reset();
  CHECK_FALSE(score_at(1e-3).value);
  CHECK_FALSE(score_at(1e-3).note.empty());
}

TEST_CASE("the regime changes at the critical speed, with intervals that hold if it sticks within its uncertainty") {
  const std::array<double, 4> speeds{0.3, 0.435, 0.443, 0.6};
  const Prediction prediction = predict_at(coulomb_example(), speeds);
  const Interval critical = *prediction.critical_speed_m_per_s.ci95;
  REQUIRE(critical.low < 0.435);
  REQUIRE(critical.high > 0.443);
  const auto& rows = prediction.rows;
  CHECK(rows[0].regime == Regime::StickSlipBistable);
  CHECK(rows[0].period_s.ci95);
  CHECK(rows[0].note.empty());
  CHECK(rows[1].regime == Regime::StickSlipBistable);
  CHECK(rows[1].period_s.value);
  CHECK(rows[1].period_s.ci95);
  CHECK_FALSE(rows[1].force_peak_N.ci95);
  CHECK(rows[1].lambda.ci95);
  CHECK_FALSE(rows[1].note.empty());
  CHECK(rows[2].regime == Regime::OscillatorySlip);
  CHECK_FALSE(rows[2].period_s.value);
  CHECK_FALSE(rows[2].note.empty());
  CHECK(rows[3].regime == Regime::OscillatorySlip);
  CHECK(rows[3].note.empty());
  CHECK(rows[3].lambda.ci95);
}

TEST_CASE("where the damping cannot be told from 0 the doubt begins where the margin says so") {
  PredictionModel model = coulomb_example();
  model.estimate.damping_ratio = 0.0;
  model.estimate.damping_identified = false;
  model.estimate.covariance[2][2] = 0.02 * 0.02;
  const std::array<double, 2> speeds{0.02, 2.0};  // zeta up to 0.04: V_c down to 0.5 m/s
  const Prediction prediction = predict_at(model, speeds);
  CHECK_FALSE(prediction.critical_speed_m_per_s.value);
  CHECK(prediction.rows[0].period_s.ci95);
  CHECK(prediction.rows[0].note.empty());
  CHECK(prediction.rows[1].period_s.ci95);
  CHECK_FALSE(prediction.rows[1].note.empty());
}

TEST_CASE(
    "speeds are a list or a logarithmic range with exact ends, and a unit that only the last has is that of all") {
  const auto list = parse_speeds("1,2.5,5 mm/s");
  REQUIRE(list);
  CHECK(list.value().speeds_m_per_s == std::vector{0.001, 0.0025, 0.005});
  CHECK(list.value().unit == "mm/s");
  const auto range = parse_speeds("1:100mm/s:3");
  REQUIRE(range);
  CHECK(range.value().speeds_m_per_s[0] == 0.001);
  CHECK(range.value().speeds_m_per_s[1] == Approx(0.01));
  CHECK(range.value().speeds_m_per_s[2] == 0.1);
  CHECK(parse_speeds("1mm/s,1m/s").value().speeds_m_per_s == std::vector{0.001, 1.0});
  CHECK(parse_speeds("0.1,0.2").value().speeds_m_per_s == std::vector{0.1, 0.2});
  CHECK(parse_speeds("0.5,5mm/s,10 mm/s").value().speeds_m_per_s == std::vector{0.5, 0.005, 0.01});
  CHECK(parse_speeds("20 mm/s,0.5").value().speeds_m_per_s == std::vector{0.02, 0.5});
}

TEST_CASE("where zeta may be 0 the end of stick-slip is told as a bound, by the interval of zeta") {
  PredictionModel model = coulomb_example();
  model.estimate.damping_ratio = 0.0;
  model.estimate.damping_identified = false;
  model.estimate.covariance = {};
  model.estimate.covariance[2][2] = 0.02 * 0.02;
  // Of a normal zeta above 0, 2.5 % lie above 2.2414 of its standard errors.
  const auto slider = Slider::create(1000.0, 200.0, 0.02 * 2.2414).value();
  const double least = *slipfit::critical_speed_m_per_s(slider, Friction::create(6.0, 4.0).value());
  const Estimate end = predict_at(model, {}).critical_speed_m_per_s;
  CHECK_FALSE(end.value);
  CHECK_FALSE(end.ci95);
  REQUIRE(end.note.rfind("above ", 0) == 0);
  CHECK(std::stod(end.note.substr(6)) == Approx(least).epsilon(0.05));
  // Beside the runs: a bracket where one does not stick, else the farther of the two bounds.
  model.observed_end = {0.1, 2.0};
  const Estimate between = predict_at(model, {}).critical_speed_m_per_s;
  REQUIRE(between.ci95);
  CHECK(between.ci95->low == Approx(least).epsilon(0.05));
  CHECK(between.ci95->high == 2.0);
  model.observed_end = {1.0, {}};
  CHECK(std::stod(predict_at(model, {}).critical_speed_m_per_s.note.substr(6)) == 1.0);
  // An interval that nobody has says nothing.
  model.observed_end = {};
  model.estimate.covariance[2][2] = 0.0;
  CHECK(predict_at(model, {}).critical_speed_m_per_s.note == "the damping ratio cannot be distinguished from 0");
}

TEST_CASE("the end of stick-slip is sought at speeds of any size") {
  PredictionModel model = coulomb_example();
  model.estimate.damping_identified = false;
  const auto least_m_per_s = [&model](double difference_N) {
    model.estimate.friction_difference_N = difference_N;
    const std::string note = predict_at(model, {}).critical_speed_m_per_s.note;
    return note.starts_with("above ") ? std::stod(note.substr(6)) : 0.0;
  };
  const double usual_m_per_s = least_m_per_s(2.0);
  REQUIRE(usual_m_per_s > 0.0);
  for (const double scale : {1e200, 1e-200}) {
    CAPTURE(scale);
    CHECK(least_m_per_s(scale * 2.0) == Approx(scale * usual_m_per_s).epsilon(1e-3));
  }
  for (const double difference_N : {1e-316, 1e308}) CHECK(least_m_per_s(difference_N) == 0.0);
}

TEST_CASE("a stated model without damping has stick-slip at every speed") {
  const PredictionModel model =
      stated_model(Slider::create(1000.0, 200.0, 0.0).value(), Friction::create(6.0, 4.0).value());
  const std::array<double, 2> speeds{0.001, 100.0};
  const Prediction prediction = predict_at(model, speeds);
  CHECK(*prediction.lambda_critical.value == 0.0);
  CHECK_FALSE(prediction.critical_speed_m_per_s.value);
  for (const PredictedMotion& row : prediction.rows) {
    CHECK(row.regime == Regime::StickSlip);
    CHECK(row.period_s.value);
  }
}

TEST_CASE("from a damping ratio of 1 on there is no stick-slip at any speed") {
  const PredictionModel model =
      stated_model(Slider::create(1000.0, 200.0, 1.5).value(), Friction::create(6.0, 4.0).value());
  const std::array<double, 1> speeds{0.01};
  const Prediction prediction = predict_at(model, speeds);
  CHECK(prediction.rows[0].regime == Regime::ContinuousSlip);
  CHECK_FALSE(prediction.rows[0].period_s.value);
  CHECK(*prediction.critical_speed_m_per_s.value == 0.0);
  CHECK_FALSE(prediction.lambda_critical.value);
}

TEST_CASE("no friction difference, no stick-slip: an answer") {
  const PredictionModel model =
      stated_model(Slider::create(1000.0, 200.0, 0.1).value(), Friction::create(4.0, 4.0).value());
  const PredictedMotion row = predicted(model, 0.01);
  CHECK(row.regime == Regime::OscillatorySlip);
  CHECK_FALSE(row.period_s.value);
}

TEST_CASE("forces need the kinetic friction, and their interval is never too narrow") {
  PredictionModel model = coulomb_example();
  const PredictedMotion row = predicted(model, 0.02);
  model.kinetic_friction_N->standard_error = 0.0;
  const double model_part = *predicted(model, 0.02).force_peak_N.standard_error;
  CHECK(*row.force_peak_N.standard_error == Approx(0.01 + model_part));
  model.kinetic_friction_N->standard_error.reset();
  CHECK(predicted(model, 0.02).force_peak_N.value);
  CHECK_FALSE(predicted(model, 0.02).force_peak_N.ci95);
  model.kinetic_friction_N.reset();
  CHECK_FALSE(predicted(model, 0.02).force_peak_N.value);
  CHECK_FALSE(predicted(model, 0.02).force_trough_N.value);
}

TEST_CASE("a covariance whose draws are mostly no models gives no crash and no narrow interval") {
  for (const std::size_t i : {0U, 1U, 2U, 3U}) {
    for (const double se : {30.0, 300.0, 3000.0, 1e100}) {
      CAPTURE(i, se);
      PredictionModel model = coulomb_example();
      model.estimate.covariance[i][i] = se * se;
      for (const double speed_m_per_s : {1e-3, 0.1, 0.44, 3.0}) {
        const PredictedMotion row = predicted(model, speed_m_per_s);  // zeta, in [0, 1), changes a period little
        if (i != 2 && row.period_s.ci95) CHECK(row.period_s.ci95->high > 1.5 * row.period_s.ci95->low);
      }
      model.estimate.damping_identified = false;
      const std::array<double, 1> speeds{0.1};
      (void)predict_at(model, speeds);
    }
  }
}
