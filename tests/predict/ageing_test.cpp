// Static friction that grows with the stick time: the limit cycle, what the fit finds, what it predicts.
#include <algorithm>
#include <array>
#include <boost/math/special_functions/lambert_w.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/statistics.hpp"
#include "differences.hpp"
#include "model/ageing.hpp"
#include "predict/critical.hpp"
#include "predict/draws.hpp"
#include "slipfit/predict/plan.hpp"
#include "slipfit/predict/prediction.hpp"
#include "slipfit/report/fit_document.hpp"
#include "slipfit/report/sweep.hpp"
#include "slipfit/sweep.hpp"
#include "speed_sweep.hpp"
#include "support/holds.hpp"
#include "support/recordings.hpp"

using namespace slipfit;
using test::critical_speed;
using test::holds;
using test::predicted;

namespace {

PredictionModel ageing_example() {
  PredictionModel model;
  model.estimate = {350.0, 26.0, 0.03, 0.14, {}, 1e9, true, std::nullopt, Ageing{0.03, 0.5}};
  test::set_errors(model, {0.01, 0.01, 0.005, 0.02, 0.0, 0.0, 0.002, 0.0});
  return model;
}

/// Under Coulomb friction that ages.
test::SpeedSweep ageing_slider() {
  test::SpeedSweep truth;
  truth.f0_N = 4.0;
  truth.f1_N = 0.0;
  truth.static_friction_N = 6.5;
  truth.ageing_N = 0.25;
  return truth;
}

const std::vector<double> kSpeeds{0.01, 0.02, 0.04, 0.08, 0.16};

/// With a cut-off of 0.3 of the middle stick, and a standard error of it.
PredictionModel cut_off_example() {
  PredictionModel model = ageing_example();
  model.estimate.ageing->cutoff_s = 0.15;
  for (std::size_t i = 0; i < kModelValues; ++i) {
    const double se = std::sqrt(model.estimate.covariance[i][i]);
    model.estimate.covariance[i][7] = model.estimate.covariance[7][i] = 0.2 * 0.03 * se;
  }
  model.estimate.covariance[7][7] = 0.03 * 0.03;
  return model;
}

/// With sticks that rise more steeply after a slip, too.
PredictionModel reloading_example() {
  PredictionModel model = cut_off_example();
  model.estimate.reloading = Reloading{0.04, 1.5e-4};
  for (std::size_t i = 0; i < 8; ++i) {
    const double se = std::sqrt(model.estimate.covariance[i][i]);
    for (const auto& [place, own] : {std::pair{std::size_t{8}, 0.003}, std::pair{std::size_t{9}, 0.05}}) {
      model.estimate.covariance[i][place] = model.estimate.covariance[place][i] = 0.2 * own * se;
    }
  }
  model.estimate.covariance[8][8] = 0.003 * 0.003;
  model.estimate.covariance[9][9] = 0.05 * 0.05;
  return model;
}

/// Without damping and with F_s - F_k >> k V / w_n.
PredictionModel undamped(PredictionModel model) {
  model.estimate.damping_ratio = 0.0;
  model.estimate.natural_frequency_rad_per_s = 1e6;
  return model;
}

/// Where the slips of the test's own integration die out.
double end_of_stick_slip(const test::SpeedSweep& truth) {
  double sticks = 0.1;
  double slides = 0.4;
  while (slides - sticks > 1e-4) {
    const double middle = 0.5 * (sticks + slides);
    (test::spacing_m(truth, middle) > 0.0 ? sticks : slides) = middle;
  }
  return sticks;
}

}  // namespace

TEST_CASE("ageing: the limit cycle is the one with the longer stick, and there is none beyond the fold") {
  // With t = a D the law is D = D0 + B ln(a D / t0): roots where D0 >= B - B ln(a B / t0), the stable one above B.
  const double rate_N = 0.05;
  const double per_N = 3.0;
  const auto stick = [&](double difference_N) { return std::optional(model::StickTime{per_N * difference_N, per_N}); };
  // A cut-off moves the fold to B - t_c / a.
  for (const double cutoff_s : {0.0, 0.03, 0.1}) {
    CAPTURE(cutoff_s);
    const double stable_above_N = rate_N - cutoff_s / per_N;
    const double fold_N = stable_above_N - rate_N * std::log(per_N * rate_N / (2.0 + cutoff_s));
    for (const double above : {1e-8, 1e-4, 0.1, 10.0}) {
      const model::AgeingLaw law{fold_N * (1.0 + above), rate_N, 2.0, cutoff_s};
      const std::optional<double> difference_N = model::aged_difference_N(law, stick);
      REQUIRE(difference_N);
      CHECK(*difference_N > stable_above_N);
      CHECK(law.after(per_N * *difference_N) == Approx(*difference_N).epsilon(1e-9));
    }
    for (const double below : {1e-6, 0.1, 0.9}) {
      CHECK_FALSE(model::aged_difference_N({fold_N * (1.0 - below), rate_N, 2.0, cutoff_s}, stick));
    }
  }
}

TEST_CASE("ageing: without damping stick-slip ends at the speed of docs/model.md (20)") {
  const PredictionModel model = undamped(ageing_example());
  const ModelEstimate& e = model.estimate;
  const double expected = 2.0 * e.ageing->rate_N / (e.stiffness_N_per_m * e.ageing->reference_stick_s) *
                          std::exp(e.friction_difference_N / e.ageing->rate_N - 1.0);
  CHECK(*critical_speed(model).value == Approx(expected).epsilon(1e-3));
}

TEST_CASE("ageing: a cut-off delays the end of stick-slip, by Lambert's function, or takes it away") {
  PredictionModel model = undamped(ageing_example());
  model.estimate.friction_difference_N = 0.05;
  Ageing& ageing = *model.estimate.ageing;
  for (const double cutoff_s : {0.02, 0.05, 0.08}) {
    CAPTURE(cutoff_s);
    ageing.cutoff_s = cutoff_s;
    const double shortest =
        (model.estimate.friction_difference_N - ageing.rate_N * std::log1p(ageing.reference_stick_s / cutoff_s)) /
        ageing.rate_N;
    REQUIRE(shortest < 0.0);
    const double expected = -2.0 * ageing.rate_N / (model.estimate.stiffness_N_per_m * cutoff_s) *
                            boost::math::lambert_w0(-std::exp(shortest - 1.0));
    CHECK(*critical_speed(model).value == Approx(expected).epsilon(1e-3));
  }
  ageing.cutoff_s = 0.2;  // F_s - F_k stays above 0 after the shortest stick
  CHECK_FALSE(critical_speed(model).value);
  CHECK(predicted(model, 1.0).period_s.value);
}

TEST_CASE("ageing: the limit of no cut-off is ageing without one") {
  const PredictionModel without = ageing_example();
  PredictionModel with = without;
  with.estimate.ageing->cutoff_s = 1e-9;
  CHECK(*critical_speed(with).value == Approx(*critical_speed(without).value).epsilon(1e-6));
  CHECK(*critical_speed(with).standard_error == Approx(*critical_speed(without).standard_error).epsilon(1e-6));
  for (const double speed : {0.0005, 0.003}) {
    CHECK(*predicted(with, speed).period_s.value == Approx(*predicted(without, speed).period_s.value).epsilon(1e-8));
  }
}

TEST_CASE("ageing: intervals follow from derivatives that agree with differences") {
  const PredictionModel model = GENERATE(ageing_example(), cut_off_example(), reloading_example());
  // The end is bracketed to 1e-14 of the speed, its F_s - F_k thereby to the root of that.
  test::check_intervals(model, 1e-6);
}

TEST_CASE("ageing: the search for quantiles of the end agrees with the ends of all models one by one") {
  // Ageing that is known to a factor of 2: linear propagation does not hold.
  PredictionModel model = ageing_example();
  model.estimate.covariance[6][6] = 0.03 * 0.03;
  std::vector<double> ends;
  for (const ModelEstimate& draw : predict::draws_of(model.estimate)) {
    ends.push_back(predict::end_of_stick_slip_m_per_s(draw, 1e-6));
  }
  const Estimate end = critical_speed(model);
  REQUIRE(end.ci95);
  // The search ends at a share of 1e-3.
  CHECK(end.ci95->low == Approx(quantile_of(ends, 0.025)).epsilon(2e-3));
  CHECK(end.ci95->high == Approx(quantile_of(ends, 0.975)).epsilon(2e-3));
}

TEST_CASE("ageing: a plan for its rate stays below the end of stick-slip and narrows it") {
  const PredictionModel model = ageing_example();
  PlanBasis basis{model.estimate, {{0.0005, 50.0, 60.0}, {0.002, 50.0, 60.0}}, 0.003, 0.01, LevelSharing::Separate};
  const Result<Plan> plan = plan_next(basis, PlanTarget{"ageing_N", std::nullopt});
  REQUIRE(plan);
  REQUIRE_FALSE(plan.value().options.empty());
  for (const PlanOption& option : plan.value().options) {
    CHECK(option.recording.speed_m_per_s < critical_speed(model).ci95->low);
    CHECK(option.standard_error < plan.value().standard_error);
  }
}

TEST_CASE("static friction that falls with the time at rest lets stick-slip begin at a speed, and damping end it") {
  PredictionModel model = ageing_example();
  model.estimate.ageing->rate_N = -0.03;
  const PredictedMotion slow = predicted(model, 1e-9);
  const PredictedMotion fast = predicted(model, 0.01);
  CHECK_FALSE(slow.period_s.value);
  CHECK(fast.period_s.value);
  const Estimate critical = critical_speed(model);
  INFO(critical.note);
  REQUIRE(critical.ci95);
  CHECK(critical.ci95->low > 0.01);
  REQUIRE(critical.value);
  CHECK(predicted(model, 0.999 * *critical.value).period_s.value);
  CHECK_FALSE(predicted(model, 1.001 * *critical.value).period_s.value);
}

TEST_CASE("ageing: a sweep tells it, and predicts the spacing between and beyond its speeds") {
  const test::SpeedSweep truth = ageing_slider();
  int inside = 0;
  int all = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const SweepAnalysis sweep = analyze_sweep(test::record(truth, kSpeeds, 100 * seed));
    REQUIRE(sweep.fit);
    REQUIRE(sweep.fit->result.estimate);
    const ModelEstimate& estimate = *sweep.fit->result.estimate;
    REQUIRE(estimate.ageing);
    CHECK(test::warns(sweep.fit->result.warnings, "static_friction_ages"));
    CHECK(estimate.ageing->rate_N == Approx(truth.ageing_N).epsilon(0.1));
    for (std::size_t i = 0; i < kSpeeds.size(); ++i) {
      const Estimate& spacing = sweep.fit->points[i].spacing_left_out_m;
      const double expected = test::spacing_m(truth, kSpeeds[i]);
      CAPTURE(seed, kSpeeds[i], expected);
      REQUIRE(spacing.value);
      CHECK(*spacing.value == Approx(expected).epsilon(0.03));
      inside += holds(spacing, expected) ? 1 : 0;
      ++all;
    }
    const PredictionModel model{estimate, true, std::nullopt};
    CHECK(predicted(model, 0.18).periodic_displacement_m.value.value_or(0.0) ==
          Approx(test::spacing_m(truth, 0.18)).epsilon(0.03));
    CHECK(holds(critical_speed(model), end_of_stick_slip(truth)));
    CHECK(*critical_speed(model).value == Approx(end_of_stick_slip(truth)).epsilon(0.1));
  }
  CAPTURE(inside, all);
  CHECK(inside >= 11);  // of 15 at 95 %
}

TEST_CASE("ageing: a sweep tells the cut-off where its sticks span enough, and none where there is none") {
  test::SpeedSweep truth = ageing_slider();
  const std::vector<double> speeds{0.0025, 0.005, 0.01, 0.02, 0.04, 0.08, 0.16};
  for (const double cutoff_s : {0.0, 0.05}) {
    truth.ageing_cutoff_s = cutoff_s;
    const SweepAnalysis sweep = analyze_sweep(test::record(truth, speeds, 500));
    REQUIRE(sweep.fit);
    const Parameter* const found = sweep.fit->result.find(ParameterId::AgeingTime);
    REQUIRE(found);
    CAPTURE(cutoff_s, *found->estimate.value, found->estimate.ci95->low, found->estimate.ci95->high);
    CHECK((cutoff_s > 0.0 ? holds(found->estimate, cutoff_s) : found->estimate.ci95->high < 0.02));
    CHECK((found->status == ParameterStatus::Bounded) == (cutoff_s == 0.0));
    const PredictionModel model{*sweep.fit->result.estimate, true, std::nullopt};
    const Estimate beyond = predicted(model, 0.18).periodic_displacement_m;
    CHECK(beyond.value.value_or(0.0) == Approx(test::spacing_m(truth, 0.18)).epsilon(0.03));
  }
}

TEST_CASE("ageing: three recordings whose static friction scatters predict by its trend") {
  test::SpeedSweep truth = ageing_slider();
  const std::vector<double> speeds{0.01, 0.02, 0.05};
  std::vector<SweepEntry> entries;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    truth.static_friction_N = ageing_slider().static_friction_N + std::array{0.04, -0.08, 0.04}.at(i);
    entries.push_back(test::record(truth, speeds[i], 700 + i));
  }
  truth.static_friction_N = ageing_slider().static_friction_N;
  const SweepAnalysis sweep = analyze_sweep(entries);
  REQUIRE(sweep.fit);
  REQUIRE(sweep.fit->result.estimate);
  REQUIRE(sweep.fit->result.estimate->ageing);
  // Not by the mean static friction of the three, which is that of longer sticks.
  const Estimate spacing = predicted({*sweep.fit->result.estimate, true, std::nullopt}, 0.1).periodic_displacement_m;
  CHECK(spacing.value.value_or(0.0) == Approx(test::spacing_m(truth, 0.1)).epsilon(0.08));
  CHECK(holds(spacing, test::spacing_m(truth, 0.1)));
}

TEST_CASE("ageing: three recordings that lie on a line by chance do not determine its rate") {
  const std::vector<double> speeds{0.01, 0.02, 0.05};
  std::mt19937_64 random(11);
  std::normal_distribution<double> scatter_N(0.0, 0.08);
  int given = 0;
  int inside = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    std::vector<SweepEntry> entries;
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      test::SpeedSweep truth = ageing_slider();
      truth.static_friction_N += scatter_N(random);
      entries.push_back(test::record(truth, speeds[i], 3000 + 10 * seed + i));
    }
    const SweepAnalysis sweep = analyze_sweep(entries);
    REQUIRE(sweep.fit);
    const Parameter* const rate = sweep.fit->result.find(ParameterId::Ageing);
    if (rate == nullptr || !rate->estimate.ci95) continue;
    ++given;
    inside += holds(rate->estimate, ageing_slider().ageing_N) ? 1 : 0;
  }
  CAPTURE(given, inside);
  CHECK(given >= 8);
  CHECK(inside + 3 >= given);  // four of 24 or more outside: 3 % by chance at 95 %
}

TEST_CASE("ageing: static friction that differs for another reason is not taken for it") {
  int taken = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    test::SpeedSweep truth = ageing_slider();
    truth.ageing_N = 0.0;
    std::vector<SweepEntry> entries;
    for (std::size_t i = 0; i < kSpeeds.size(); ++i) {
      truth.static_friction_N = 6.0 + 0.3 * std::sin(static_cast<double>(7 * seed + 3 * i * i));  // no trend
      entries.push_back(test::record(truth, kSpeeds[i], 1000 * seed + i));
    }
    const SweepAnalysis sweep = analyze_sweep(entries);
    REQUIRE(sweep.fit);
    CHECK_FALSE(sweep.fit->difference_shared);
    taken += sweep.fit->result.estimate && sweep.fit->result.estimate->ageing ? 1 : 0;
  }
  CHECK(taken <= 1);  // of 8 at 1 %
}

TEST_CASE("next to the end of stick-slip the motion is known for a static friction that is found roughly") {
  constexpr double kRough = 1e-4;
  for (const double zeta : {0.01, 0.05, 0.1, 0.1657, 0.3}) {
    for (const double rate_N : {0.01, 0.03, 0.0575, 0.1}) {
      for (const double stiffness_N_per_m : {300.0, 378.83, 420.0}) {
        ModelEstimate model = ageing_example().estimate;
        model.stiffness_N_per_m = stiffness_N_per_m;
        model.natural_frequency_rad_per_s = 44.114;
        model.damping_ratio = zeta;
        model.friction_difference_N = 1.0919;
        model.ageing = Ageing{rate_N, 1.4246};
        double sticks = 1e-6;
        double slides = 10.0;
        while (slides > (1.0 + 1e-14) * sticks) {
          const double middle = std::sqrt(sticks * slides);
          (predict::sticks_at(model, middle, kRough) ? sticks : slides) = middle;
          const predict::ModelMotion motion = predict::motion_at(model, middle, kRough);
          CAPTURE(zeta, rate_N, stiffness_N_per_m, middle);
          CHECK(motion.cycle.has_value() ==
                (motion.regime == Regime::StickSlip || motion.regime == Regime::StickSlipBistable));
        }
      }
    }
  }
}

TEST_CASE("a document whose static friction falls with the time of rest is read as well") {
  const std::vector<SweepEntry> entries = test::record(ageing_slider(), kSpeeds, 100);
  nlohmann::json document = nlohmann::json::parse(to_json(entries, analyze_sweep(entries)));
  nlohmann::json& correlation = document["correlation"];
  for (std::size_t i = 0; i < correlation["names"].size(); ++i) {
    if (correlation["names"][i] == "ageing_N") correlation["values"][i] = -0.1;
  }
  const auto read = read_fit_document(document.dump(), "fit.json");
  REQUIRE(read);
  REQUIRE(read.value().model.estimate.ageing);
  CHECK(read.value().model.estimate.ageing->rate_N == -0.1);
}
