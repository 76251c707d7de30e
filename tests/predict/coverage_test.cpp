// Bands of predictions against what they promise: draws from the covariance, and fits of simulated recordings.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "slipfit/model/simulation.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/predict/prediction.hpp"
#include "support/holds.hpp"
#include "support/recordings.hpp"

using namespace slipfit;

namespace {

PredictionModel fitted_model(std::uint64_t seed, const Slider& slider, const Friction& friction, double speed_m_per_s) {
  SimulationOptions options;
  const LimitCycle cycle = *damped_motion(slider, friction, speed_m_per_s).cycle;
  options.duration_s = 40.0 * cycle.period_s;
  options.sample_rate_Hz = 30.0 / cycle.slip_s;
  options.noise_rms_N = 0.01 * friction.difference_N();
  options.static_friction_sd_N = 0.02 * friction.difference_N();
  options.seed = seed;
  SimulatedTrace trace = simulate(slider, friction, speed_m_per_s, options);
  const Recording recording = test::recording_of(std::move(trace.time_s), std::move(trace.force_N), speed_m_per_s);
  const Analysis analysis = analyze_and_fit(recording);
  REQUIRE(analysis.fit);
  REQUIRE(analysis.fit->estimate);
  PredictionModel model;
  model.estimate = *analysis.fit->estimate;
  model.has_covariance = true;
  return model;
}

/// How many of the motions lie inside the bands of a row.
struct Inside {
  int period = 0, slip = 0, stick = 0, sticking = 0;

  void count(const PredictedMotion& row, const Motion& motion) {
    if (!motion.cycle) return;
    period += test::holds(row.period_s, motion.cycle->period_s) ? 1 : 0;
    slip += test::holds(row.slip_time_s, motion.cycle->slip_s) ? 1 : 0;
    stick += test::holds(row.stick_time_s, motion.cycle->stick_s) ? 1 : 0;
    sticking += test::holds(row.sticking_degree, motion.cycle->sticking_degree) ? 1 : 0;
  }
  [[nodiscard]] int least() const { return std::min({period, slip, stick, sticking}); }
};

}  // namespace

TEST_CASE("bands hold 95 % of the motions that the covariance allows, up to the doubt around the critical speed") {
  PredictionModel model;
  model.estimate = {1000.0, 200.0, 0.05, 2.0, {}, 1e9, true};
  model.has_covariance = true;
  const std::array<double, 4> se{0.002, 0.003, 0.0025, 0.008};
  for (std::size_t i = 0; i < 4; ++i) model.estimate.covariance[i][i] = se[i] * se[i];
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const std::vector<double> speeds{0.001, 0.02, 0.1, 0.3, 0.35, 0.38, 0.39, 0.395, 0.4};
  const Prediction prediction = predict_at(model, speeds);
  CHECK(prediction.critical_speed_m_per_s.ci95->low < 0.42);  // the last speeds are close to the edge
  constexpr int kDraws = 4000;
  for (const PredictedMotion& row : prediction.rows) {
    REQUIRE(row.period_s.ci95);
    Inside inside;
    for (int draw = 0; draw < kDraws; ++draw) {
      const auto slider = Slider::create(1000.0 * std::exp(se[0] * normal(random)),
                                         200.0 * std::exp(se[1] * normal(random)), 0.05 + se[2] * normal(random));
      const auto friction = Friction::create(2.0 * std::exp(se[3] * normal(random)), 0.0);
      inside.count(row, damped_motion(slider.value(), friction.value(), row.speed_m_per_s));
    }
    CAPTURE(row.speed_m_per_s, inside.period, inside.slip, inside.stick, inside.sticking);
    CHECK(inside.least() > 0.93 * kDraws);  // 3800 expected, standard deviation 14; the edge costs up to 1.5 %
  }
}

TEST_CASE("where the data cannot tell whether there is stick-slip, bands hold the motions that stick") {
  PredictionModel model;
  model.estimate = {1000.0, 200.0, 0.05, 2.0, {}, 1e9, true};
  model.has_covariance = true;
  const std::array<double, 4> se{0.002, 0.003, 0.02, 0.008};
  for (std::size_t i = 0; i < 4; ++i) model.estimate.covariance[i][i] = se[i] * se[i];
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const Prediction prediction = predict_at(model, std::vector<double>{0.3, 0.4, 0.43});
  for (const PredictedMotion& row : prediction.rows) {
    CHECK(row.note.find("hold if there is") != std::string::npos);
    REQUIRE(row.period_s.ci95);
    Inside inside;
    int sticking = 0;
    for (int draw = 0; draw < 4000; ++draw) {
      const double zeta = 0.05 + se[2] * normal(random);
      if (zeta < 0.0) continue;
      const auto slider =
          Slider::create(1000.0 * std::exp(se[0] * normal(random)), 200.0 * std::exp(se[1] * normal(random)), zeta);
      const auto friction = Friction::create(2.0 * std::exp(se[3] * normal(random)), 0.0);
      const Motion motion = damped_motion(slider.value(), friction.value(), row.speed_m_per_s);
      sticking += motion.cycle ? 1 : 0;
      inside.count(row, motion);
    }
    CAPTURE(row.speed_m_per_s, sticking, inside.period, inside.slip, inside.stick, inside.sticking);
    CHECK(sticking < 3900);                   // linear bands would be of the others, too
    CHECK(inside.least() > 0.92 * sticking);  // 800 draws tell where 2.5 % lie to 0.6 %
    CHECK(inside.period < 0.98 * sticking);
  }
}

TEST_CASE("a fit at one speed predicts the true motion at twice the speed, within its bands") {
  const Slider slider = Slider::create(800.0, 150.0, 0.06).value();
  const Friction friction = Friction::create(3.0, 1.8).value();
  const std::array<double, 1> speeds{0.02};
  const Motion truth = damped_motion(slider, friction, speeds[0]);
  constexpr int kSeeds = 100;
  Inside inside;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const PredictionModel model = fitted_model(seed, slider, friction, 0.5 * speeds[0]);
    const PredictedMotion row = predict_at(model, speeds).rows.front();
    inside.count(row, truth);
    // 5 standard errors: about one miss in 100 000 with these degrees of freedom.
    CAPTURE(seed, *row.period_s.value, *row.period_s.standard_error, truth.cycle->period_s);
    CHECK(std::abs(*row.period_s.value - truth.cycle->period_s) < 5.0 * *row.period_s.standard_error);
  }
  CAPTURE(inside.period, inside.slip, inside.stick, inside.sticking);
  // 93 to 95 of 100 over 600 seeds (scattering cycles), standard deviation 2.6
  CHECK(inside.least() >= 87);
}
