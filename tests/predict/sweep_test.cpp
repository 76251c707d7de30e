// Fits of sweeps of simulated sweeps: what they predict at speeds that were not measured.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "slipfit/background.hpp"
#include "slipfit/predict/prediction.hpp"
#include "slipfit/sweep.hpp"
#include "speed_sweep.hpp"
#include "support/holds.hpp"
#include "support/recordings.hpp"

using namespace slipfit;
using test::holds;

namespace {

const Parameter& parameter(const SweepAnalysis& sweep, std::string_view name) {
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

}  // namespace

TEST_CASE("a sweep of three speeds predicts the spacing at twice and four times the fastest of them") {
  int inside = 0;
  int all = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const double alpha : {-8.0, -3.0, 1.0}) {
      test::SpeedSweep truth;
      truth.alpha_s_per_m = alpha;
      const SweepAnalysis sweep = analyze_sweep(test::record(truth, {0.01, 0.02, 0.04}, 100 * seed));
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
  const SweepAnalysis sweep = analyze_sweep(test::record(truth, {0.01, 0.03, 0.1, 0.2}, 7));
  const ModelEstimate& estimate = model_of(sweep).estimate;
  REQUIRE(estimate.speed_dependence);
  CHECK(holds(parameter(sweep, "friction_slope_N_s_per_m").estimate, truth.f1_N * truth.alpha_s_per_m));
  CHECK(estimate.covariance[4][4] > 0.0);
  CHECK(estimate.covariance[5][5] > 0.0);
  const Correlation& correlation = *sweep.fit->result.correlation;
  CHECK(correlation.names.size() == 6);
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
  FitResult by_law = sweep.fit->result;
  by_law.estimate->reach.reset();
  const Derived derived = derive_from_sweep(by_law, {});
  CAPTURE(low, *derived.critical_speed_m_per_s.value);
  CHECK(holds(derived.critical_speed_m_per_s, low));
  // Beyond the recordings it rests on the law.
  REQUIRE(low > 1.5 * 0.2);
  CHECK_FALSE(sweep.derived.critical_speed_m_per_s.value);
  CHECK_THAT(sweep.derived.critical_speed_m_per_s.note,
             Catch::Contains("above 0.2 m/s") && Catch::Contains("another law"));
}

TEST_CASE("two recordings, or speeds near each other, tell no interval far from their speeds") {
  test::SpeedSweep truth;
  truth.f1_N = 0.0;
  for (const std::vector<double>& speeds : {std::vector{0.01, 0.04}, std::vector{0.02, 0.022, 0.025, 0.028}}) {
    const SweepAnalysis sweep = analyze_sweep(test::record(truth, speeds, 3));
    const PredictionModel model = model_of(sweep);
    REQUIRE(model.estimate.reach);
    CHECK_FALSE(model.estimate.reach->trend);
    const Prediction prediction = predict_at(model, std::vector<double>{1.4 * speeds.back(), 2.0 * speeds.back()});
    CHECK(prediction.rows[0].periodic_displacement_m.ci95);
    CHECK(prediction.rows[1].periodic_displacement_m.value);
    CHECK_FALSE(prediction.rows[1].periodic_displacement_m.ci95);
    CHECK_THAT(prediction.rows[1].note, Catch::Contains("cannot tell whether static friction ages"));
    CHECK_FALSE(prediction.critical_speed_m_per_s.value);
    CHECK_FALSE(sweep.derived.critical_speed_m_per_s.value);
  }
}

TEST_CASE("bands beyond the speeds of a sweep grow with the trend of its static friction") {
  test::SpeedSweep truth;
  truth.f1_N = 0.0;
  truth.ageing_N = 0.1;
  const std::vector<double> speeds{0.01, 0.02, 0.04};
  const SweepAnalysis sweep = analyze_sweep(test::record(truth, speeds, 5));
  PredictionModel model = model_of(sweep);
  REQUIRE(model.estimate.reach);
  REQUIRE(model.estimate.reach->trend);
  // F_s - F_k(0+) is about 2.5 N there, and falls by 0.1 N a factor of e.
  CHECK(*model.estimate.reach->trend == Approx(0.04).epsilon(0.3));
  const std::vector<double> unseen{0.03, 0.16, 0.04};
  const Prediction with_trend = predict_at(model, unseen);
  model.estimate.reach->trend = 0.0;
  const Prediction without = predict_at(model, unseen);
  const auto width = [](const PredictedMotion& row) {
    return row.periodic_displacement_m.ci95->high / row.periodic_displacement_m.ci95->low;
  };
  CHECK(width(with_trend.rows[0]) == width(without.rows[0]));
  CHECK(width(with_trend.rows[1]) > width(without.rows[1]) * 1.02);
  CHECK(width(with_trend.rows[2]) > width(without.rows[2]) * 1.002);  // the fastest: a line misses there what bends
  CHECK(holds(with_trend.rows[1].periodic_displacement_m, test::spacing_m(truth, 0.16)));
}

TEST_CASE("a prediction under another load scales friction, and F_k is then not known") {
  PredictionModel model = stated_model(Slider::create(1000.0, 200.0, 0.1).value(), Friction::create(6.0, 4.0).value());
  model.estimate.normal_force_N = 2.0;
  const std::vector<double> speed{0.02};
  const PredictedMotion twice = predict_at(at_load(model, 4.0), speed).rows[0];
  const PredictionModel heavier =
      stated_model(Slider::create(1000.0, 200.0, 0.1).value(), Friction::create(12.0, 8.0).value());
  CHECK(*twice.periodic_displacement_m.value ==
        Approx(*predict_at(heavier, speed).rows[0].periodic_displacement_m.value).epsilon(1e-12));
  CHECK_FALSE(twice.force_peak_N.value);
  CHECK(predict_at(at_load(model, 2.0), speed).rows[0].force_peak_N.value);
}

TEST_CASE("a sweep names the recording that is not like the others, and one that counts twice") {
  test::SpeedSweep truth;
  truth.f1_N = 0.0;
  const std::vector<double> speeds{0.01, 0.02, 0.04, 0.08};
  const auto codes = [](const Warnings& warnings) {
    std::vector<std::string> all;
    for (const Warning& warning : warnings) all.push_back(warning.code);
    return all;
  };
  const auto message = [](const Warnings& warnings, const std::string& code) {
    for (const Warning& warning : warnings) {
      if (warning.code == code) return warning.message;
    }
    return std::string();
  };
  const std::vector<SweepEntry> sound = test::record(truth, speeds, 11);
  CHECK_THAT(codes(analyze_sweep(sound).warnings), !Catch::VectorContains(std::string("recording_disagrees")));

  test::SpeedSweep harder = truth;
  harder.static_friction_N = 6.6;
  std::vector<SweepEntry> other_surface = sound;
  other_surface[2].recording = test::record(harder, speeds[2], 12).recording;
  CHECK_THAT(message(analyze_sweep(other_surface).warnings, "recording_disagrees"),
             Catch::Contains("'" + sound[2].id + "'") && Catch::Contains("spacing"));

  std::vector<SweepEntry> wrong_speed = sound;
  Conditions conditions = sound[1].recording.conditions();
  conditions.speed_m_per_s *= 1.1;
  wrong_speed[1].recording = test::with_conditions(sound[1].recording, conditions);
  CHECK_THAT(message(analyze_sweep(wrong_speed).warnings, "recording_disagrees"),
             Catch::Contains("'" + sound[1].id + "'") && Catch::Contains("stiffness"));

  std::vector<SweepEntry> twice = sound;
  twice.push_back(sound[0]);
  twice.back().id = "again";
  CHECK_THAT(message(analyze_sweep(twice).warnings, "recording_repeated"), Catch::Contains("'again'"));
}

TEST_CASE("a stiffness that varies with driving speed is the fault of no recording") {
  test::SpeedSweep truth;
  truth.f1_N = 0.0;
  std::vector<SweepEntry> entries;
  for (const double speed : {0.01, 0.02, 0.04, 0.08}) {
    test::SpeedSweep at_speed = truth;
    at_speed.stiffness_N_per_m *= std::pow(speed / 0.01, 0.05);  // 11 % over the sweep
    entries.push_back(test::record(at_speed, speed, 20 + entries.size()));
  }
  const SweepAnalysis sweep = analyze_sweep(entries);
  for (const Warning& warning : sweep.warnings) CHECK(warning.code != "recording_disagrees");
}

TEST_CASE("recordings whose slips lie within a sample are left out where others suffice, and said") {
  test::SpeedSweep truth;
  truth.f1_N = 0.0;
  truth.static_friction_sd_N = 0.002;  // where slips begin over many places of the clock, many of them tell its shape
  std::vector<SweepEntry> entries = test::record(truth, {0.001, 0.02, 0.04, 0.08}, 31);
  const Recording& slow = entries[0].recording;
  const auto every = static_cast<std::size_t>(1.3 * test::slip_s(truth, 0.001) / slow.sample_interval_s());
  std::vector<double> time_s;
  std::vector<double> force;
  for (std::size_t i = 0; i < slow.size(); i += every) {
    time_s.push_back(slow.time_s()[i]);
    force.push_back(slow.force()[i]);
  }
  entries[0].recording = Recording::create(time_s, force, slow.conditions(), slow.provenance()).value();
  const SweepAnalysis sweep = analyze_sweep(entries);
  CHECK(sweep.roles[0] == SweepRole::LeftOut);
  CHECK(std::any_of(sweep.warnings.begin(), sweep.warnings.end(), [&](const Warning& warning) {
    return warning.code == "slips_not_resolved" && warning.message.find(entries[0].id) != std::string::npos;
  }));
  CHECK(parameter(sweep, "natural_frequency_rad_per_s").status == ParameterStatus::Conditional);
  CHECK(holds(parameter(sweep, "natural_frequency_rad_per_s").estimate, truth.omega_rad_per_s));
  // The only ones with a speed of their own have to do.
  const std::vector<SweepEntry> two(entries.begin(), entries.begin() + 2);
  CHECK(analyze_sweep(two).roles[0] == SweepRole::Cycles);
}

TEST_CASE("the spacing that the other recordings predict for one left out holds the truth") {
  test::SpeedSweep truth;
  int inside = 0;
  int all = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const std::vector<SweepEntry> entries = test::record(truth, {0.01, 0.02, 0.04, 0.08, 0.16}, 1000 * seed);
    const SweepAnalysis sweep = analyze_sweep(entries);
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
  const SweepAnalysis sweep = analyze_sweep(test::record(truth, {0.01, 0.02, 0.04}, 21));
  REQUIRE(sweep.fit);
  const Estimate by_fit = derive_from_sweep(sweep.fit->result, {0.04, {}}).critical_speed_m_per_s;
  REQUIRE(by_fit.value);
  const double faster = 10.0 * by_fit.ci95->high;
  CHECK_FALSE(derive_from_sweep(sweep.fit->result, {faster, {}}).critical_speed_m_per_s.value);
  CHECK(derive_from_sweep(sweep.fit->result, {faster, 2.0 * faster}).critical_speed_m_per_s.ci95->low == faster);
}

TEST_CASE("the end of stick-slip by a fit lies between the runs that stick and those that do not") {
  test::SpeedSweep truth;
  truth.f1_N = 0.0;
  const std::vector<SweepEntry> entries = test::record(truth, {0.02, 0.04, 0.08, 0.16}, 9);
  SweepAnalysis sweep = analyze_sweep(entries);
  const Estimate by_fit = sweep.derived.critical_speed_m_per_s;
  REQUIRE(by_fit.ci95);
  const auto with = [&](double sticks, double slides) {
    return derive_from_sweep(sweep.fit->result, {sticks, slides}).critical_speed_m_per_s;
  };
  const Estimate wide = with(0.16, 10.0);
  CHECK(*wide.value == *by_fit.value);
  CHECK(wide.ci95->low == by_fit.ci95->low);
  const Estimate cut = with(*by_fit.value * 1.0001, 10.0);
  CHECK(cut.ci95->low == *by_fit.value * 1.0001);
  CHECK(cut.ci95->high == by_fit.ci95->high);
  CHECK(*cut.value == cut.ci95->low);
  // The fit puts it where a run slides: the runs hold.
  const Estimate contradicted = with(0.16, 0.18);
  REQUIRE(by_fit.ci95->low > 0.18);
  CHECK(contradicted.ci95->high == 0.18);
  CHECK_THAT(contradicted.note, Catch::Contains("above a speed at which a run slides"));
  // A prediction tells the same, and so does the picture of the page.
  PredictionModel model = model_of(sweep);
  model.observed_end = {0.16, 0.18};
  CHECK(predict_at(model, {}).critical_speed_m_per_s.ci95->high == 0.18);
  sweep.derived.observed_end = ObservedEnd{0.16, 0.18};
  CHECK(predict_around(entries, sweep)->critical_speed_m_per_s.ci95->high == 0.18);
}
