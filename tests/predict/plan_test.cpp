// Plans against the fits that they forecast.
#include "slipfit/predict/plan.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string_view>
#include <vector>

#include "slipfit/sweep.hpp"
#include "speed_sweep.hpp"

using namespace slipfit;

namespace {

PlanBasis basis_of(const std::vector<SweepEntry>& entries, const SweepAnalysis& sweep) {
  REQUIRE(sweep.fit);
  REQUIRE(sweep.fit->result.estimate);
  PlanBasis basis;
  basis.estimate = *sweep.fit->result.estimate;
  basis.levels = sweep.fit->level_shared ? LevelSharing::Shared : LevelSharing::Separate;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Recording& recording = entries[i].recording;
    basis.recordings.push_back(
        {recording.conditions().speed_m_per_s, 1.0 / recording.sample_interval_s(), recording.duration_s()});
    basis.noise_rms_N = *sweep.fit->points[i].rms;
    basis.force_drop_sd_N = sweep.recordings[i].cycles.force_drop_sd;
  }
  return basis;
}

const ParameterLimit& limit_of(const Plan& plan, std::string_view name) {
  const auto found =
      std::find_if(plan.limits.begin(), plan.limits.end(), [&](const ParameterLimit& l) { return l.name == name; });
  REQUIRE(found != plan.limits.end());
  return *found;
}

PlanBasis fitted_basis(const test::SpeedSweep& truth, const std::vector<double>& speeds, std::uint64_t seed) {
  const std::vector<SweepEntry> entries = test::record(truth, speeds, seed);
  return basis_of(entries, analyze_sweep(entries));
}

}  // namespace

TEST_CASE("noise and scatter explain the standard errors of a fit of simulated recordings") {
  int compared = 0;
  for (const std::uint64_t seed : {10U, 20U, 30U, 40U}) {
    const std::vector<SweepEntry> entries = test::record({}, {0.01, 0.02, 0.04}, seed);
    const SweepAnalysis sweep = analyze_sweep(entries);
    // With one level and one static friction for all, as simulated; by chance a fit refuses that now and then.
    if (!sweep.fit->level_shared || !sweep.fit->difference_shared || !sweep.fit->result.warnings.empty()) continue;
    ++compared;
    const Plan plan = plan_next(basis_of(entries, sweep), std::nullopt).value();
    for (const ParameterLimit& limit : plan.limits) {
      CAPTURE(seed, limit.name, limit.standard_error, limit.explained_error);
      CHECK(limit.standard_error > 0.7 * limit.explained_error);
      CHECK(limit.standard_error < 1.4 * limit.explained_error);
    }
  }
  CHECK(compared >= 2);
}

TEST_CASE("the standard error that a plan promises is the one that the fit with the new recording has") {
  const test::SpeedSweep truth;
  const std::vector<double> before{0.01, 0.02, 0.04};
  const PlanBasis basis = fitted_basis(truth, before, 40);
  const Plan plan = plan_next(basis, PlanTarget{"alpha_s_per_m", std::nullopt}).value();
  const auto option = std::find_if(plan.options.begin(), plan.options.end(), [](const PlanOption& o) {
    return std::abs(o.recording.speed_m_per_s - 0.16) < 1e-6;
  });
  REQUIRE(option != plan.options.end());
  CHECK(option->standard_error < 0.6 * plan.standard_error);  // a wider span of speeds is what alpha needs
  std::vector<SweepEntry> entries = test::record(truth, before, 40);
  entries.push_back(test::record(truth, 0.16, 99));
  const PlanBasis after = basis_of(entries, analyze_sweep(entries));
  const double achieved = std::sqrt(after.estimate.covariance[5][5]);
  // The new recording is as many cycles long as the others, not as long in time.
  const double share = after.recordings.back().duration_s / option->recording.duration_s;
  CAPTURE(plan.standard_error, option->standard_error, achieved, share);
  CHECK(achieved < plan.standard_error);
  CHECK(achieved > 0.6 * option->standard_error);
  CHECK(achieved < 1.6 * option->standard_error / std::sqrt(share));
}

TEST_CASE("a plan says whether noise, scatter or sampling limits a parameter") {
  PlanBasis basis = fitted_basis({}, {0.01, 0.02, 0.04}, 50);
  basis.estimate.speed_dependence.reset();
  for (auto& row : basis.estimate.covariance) row[4] = row[5] = 0.0;
  basis.estimate.covariance[4] = basis.estimate.covariance[5] = {};
  // More noise, more scatter or a slower clock than the fit had: so its interval is no misfit.
  const auto limit_with = [&basis](double noise, double scatter_N, const std::string& name, double rate) {
    PlanBasis other = basis;
    other.noise_rms_N *= noise;
    other.force_drop_sd_N = scatter_N;
    for (RecordingPlan& recording : other.recordings) recording.sample_rate_Hz *= rate;
    return limit_of(plan_next(other, PlanTarget{name, std::nullopt}).value(), name).limit;
  };
  CHECK(limit_with(1.0, 0.02, "stiffness_N_per_m", 1.0) == Limit::Noise);
  CHECK(limit_with(1.0, 0.001, "natural_frequency_rad_per_s", 1.0 / 64.0) == Limit::Sampling);  // 0.4 in a slip
  PlanBasis damped = basis;
  for (auto& row : damped.estimate.covariance) row[2] = 0.0;
  damped.estimate.covariance[2] = {};  // zeta held: else scatter helps, it tells zeta from the force level
  std::swap(basis, damped);
  CHECK(limit_with(0.1, 1.0, "friction_difference_N", 1.0) == Limit::Scatter);
  std::swap(basis, damped);
  for (auto& row : basis.estimate.covariance) {
    for (double& cell : row) cell *= 100.0;
  }
  const Plan wide = plan_next(basis, std::nullopt).value();
  CHECK(limit_of(wide, "stiffness_N_per_m").limit == Limit::Misfit);
}

TEST_CASE("options come best first, with enough cycles, below the end of stick-slip, and halving needs what it says") {
  const PlanBasis basis = fitted_basis({}, {0.01, 0.02, 0.04}, 60);
  const Plan plan = plan_next(basis, PlanTarget{"periodic_displacement_m", 0.1}).value();
  REQUIRE(plan.options.size() >= 3);
  for (std::size_t i = 0; i < plan.options.size(); ++i) {
    CHECK(plan.options[i].cycles >= 5.0);
    CHECK(plan.options[i].standard_error < plan.standard_error);
    if (i > 0) CHECK(plan.options[i].standard_error >= plan.options[i - 1].standard_error);
  }
  CHECK(plan.halving_s);
}

TEST_CASE("one recording is no basis for a plan of the displacement at another speed") {
  PlanBasis basis = fitted_basis({}, {0.01, 0.02, 0.04}, 70);
  basis.recordings.resize(1);
  const double speed_m_per_s = basis.recordings.front().speed_m_per_s;
  CHECK(plan_next(basis, PlanTarget{"periodic_displacement_m", speed_m_per_s}));
  CHECK_THAT(plan_next(basis, PlanTarget{"periodic_displacement_m", 3.0 * speed_m_per_s}).error().message,
             Catch::Contains("record at that speed"));
}

TEST_CASE("recordings are not planned for force recovery, which the planned cycles do not have") {
  PlanBasis basis = fitted_basis({}, {0.01, 0.02, 0.04}, 70);
  basis.estimate.reloading = Reloading{0.04, 1.5e-4};
  basis.estimate.covariance[8][8] = 1e-6;
  basis.estimate.covariance[9][9] = 1e-3;
  const Plan plan = plan_next(basis, std::nullopt).value();
  for (const ParameterLimit& limit : plan.limits) CHECK_FALSE(limit.name.starts_with("reload"));
  CHECK_THAT(plan_next(basis, PlanTarget{"reload_force_N", std::nullopt}).error().message,
             Catch::Contains("not planned for reload_force_N"));
}

TEST_CASE("a target that the model does not have is refused") {
  PlanBasis basis = fitted_basis({}, {0.01, 0.02, 0.04}, 70);
  const auto refused = [&basis](const PlanTarget& target) { return plan_next(basis, target).error().message; };
  CHECK_THAT(refused({"colour", std::nullopt}), Catch::Contains("unknown target 'colour'"));
  CHECK_THAT(refused({"periodic_displacement_m", std::nullopt}), Catch::Contains("needs a speed"));
  CHECK_THAT(refused({"periodic_displacement_m", 100.0}), Catch::Contains("no stick-slip"));
  for (std::size_t i = 0; i < kModelValues; ++i)
    basis.estimate.covariance[0][i] = basis.estimate.covariance[i][0] = 0.0;
  CHECK_THAT(refused({"stiffness_N_per_m", std::nullopt}), Catch::Contains("held"));
  CHECK(limit_of(plan_next(basis, std::nullopt).value(), "stiffness_N_per_m").limit == Limit::Held);
}
