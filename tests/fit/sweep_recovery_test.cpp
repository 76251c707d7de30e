#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "slipfit/pipeline.hpp"
#include "slipfit/sweep.hpp"
#include "support/recordings.hpp"
#include "sweep_recordings.hpp"

using namespace slipfit;
using test::SweepScene;

namespace {

const std::vector<double> kSpeeds{0.005, 0.01, 0.02, 0.04};

const Parameter& parameter(const SweepAnalysis& sweep, std::string_view name) {
  for (const Parameter& p : sweep.fit->result.parameters) {
    if (p.name() == name) return p;
  }
  FAIL("no parameter " << name);
  return sweep.fit->result.parameters.front();
}

/// Every parameter with a value lies within 4 standard errors of the truth.
void check_recovery(const SweepAnalysis& sweep, const SweepScene& s) {
  const std::map<std::string, double> truths{{"stiffness_N_per_m", s.stiffness_N_per_m},
                                             {"natural_frequency_rad_per_s", s.natural_frequency_rad_per_s},
                                             {"damping_ratio", s.damping_ratio},
                                             {"friction_difference_N", s.static_friction_N - s.kinetic_friction_N()},
                                             {"alpha_s_per_m", s.alpha_s_per_m},
                                             {"f0_N", s.f0_N},
                                             {"f1_N", s.f1_N}};
  for (const auto& [name, truth] : truths) {
    const Parameter& p = parameter(sweep, name);
    if (!p.estimate.value) continue;
    INFO(name << " = " << *p.estimate.value << " +- " << *p.estimate.standard_error << ", truth " << truth);
    CHECK(std::abs(*p.estimate.value - truth) < 4.0 * *p.estimate.standard_error);
  }
}

/// A constant force with noise, for 4 s.
Recording steady_recording(double force_N, double noise_N, double speed_m_per_s, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(force_N, noise_N);
  std::vector<double> time_s;
  std::vector<double> forces_N;
  for (int i = 0; i < 4000; ++i) {
    time_s.push_back(1e-3 * i);
    forces_N.push_back(noise(random));
  }
  return test::recording_of(std::move(time_s), std::move(forces_N), speed_m_per_s);
}

/// A sweep whose recordings differ in more than the speed.
std::vector<SweepEntry> record_each(const std::vector<double>& speeds_m_per_s,
                                    const std::function<SweepScene(std::size_t)>& scene_of) {
  std::vector<SweepEntry> entries;
  for (std::size_t i = 0; i < speeds_m_per_s.size(); ++i) {
    SweepScene scene = scene_of(i);
    scene.seed = i + 1;
    entries.push_back(test::record_sweep(scene, {speeds_m_per_s[i]}).front());
  }
  return entries;
}

}  // namespace

TEST_CASE("sweep: alpha and damping are told apart by a sweep") {
  SweepScene scene;
  for (const double scatter_N : {0.0, 0.02}) {
    scene.scatter_N = scatter_N;
    const SweepAnalysis sweep = analyze_sweep(test::record_sweep(scene, kSpeeds));
    REQUIRE(sweep.fit);
    CHECK(sweep.fit->result.tier == Tier::Velocity);
    CHECK(sweep.fit->level_shared);
    CHECK(sweep.fit->difference_shared);
    CHECK(parameter(sweep, "alpha_s_per_m").status == ParameterStatus::Identified);
    CHECK(parameter(sweep, "damping_ratio").status == ParameterStatus::Identified);
    check_recovery(sweep, scene);
  }
}

TEST_CASE("sweep: a steadily sliding recording pins the kinetic friction at its speed") {
  const SweepScene scene;
  constexpr double kFast_m_per_s = 0.5;
  const double truth_N = scene.f0_N + scene.f1_N * std::exp(scene.alpha_s_per_m * kFast_m_per_s);
  std::vector<SweepEntry> entries = test::record_sweep(scene, kSpeeds);
  const SweepAnalysis without = analyze_sweep(entries);
  entries.push_back({"fast", steady_recording(truth_N, scene.noise_N, kFast_m_per_s, 31)});
  const SweepAnalysis sweep = analyze_sweep(entries);
  REQUIRE(without.fit);
  REQUIRE(sweep.fit);
  CHECK(sweep.roles.back() == SweepRole::Steady);
  CHECK(sweep.fit->level_shared);
  check_recovery(sweep, scene);
  const Estimate& friction = sweep.fit->points.back().kinetic_friction_N;
  REQUIRE(friction.value);
  CHECK(std::abs(*friction.value - truth_N) < 4.0 * *friction.standard_error);
  CHECK(*parameter(sweep, "f0_N").estimate.standard_error < 0.5 * *parameter(without, "f0_N").estimate.standard_error);
}

TEST_CASE("sweep: recordings through a sensor of first order share their friction") {
  SweepScene scene{.samples_per_half_period = 100.0, .lag_s = 0.5 / 150.0};  // w_n T = 0.5
  SECTION("friction that depends on the speed") {}
  SECTION("Coulomb friction") {
    scene.f0_N = 2.0;
    scene.f1_N = 0.0;
  }
  SECTION("the force that spring and damper transmit together") {
    scene.view = ForceView::Transmitted;
  }
  const SweepAnalysis sweep = analyze_sweep(test::record_sweep(scene, kSpeeds));
  REQUIRE(sweep.fit);
  CHECK(sweep.fit->result.tier == (scene.f1_N > 0.0 ? Tier::Velocity : Tier::Damped));
  CHECK(sweep.fit->level_shared);
  CHECK(sweep.fit->difference_shared);
  CHECK_FALSE(test::warns(sweep.fit->result.warnings, "static_friction_ages"));
  CHECK(*sweep.fit->result.residual.reduced_chi2 == Approx(1.0).margin(0.1));
  check_recovery(sweep, scene);
}

TEST_CASE("sweep: an uncertain speed is in k, and in nothing that the data give without it") {
  constexpr double kSpeedError = 0.02;
  std::vector<SweepEntry> entries = test::record_sweep({}, kSpeeds);
  const SweepAnalysis exact = analyze_sweep(entries);
  for (SweepEntry& entry : entries) {
    Conditions conditions = entry.recording.conditions();
    conditions.speed_standard_error_m_per_s = kSpeedError * conditions.speed_m_per_s;
    entry.recording = test::with_conditions(entry.recording, conditions);
  }
  const SweepAnalysis uncertain = analyze_sweep(entries);
  const auto relative_se = [](const Estimate& estimate) { return *estimate.standard_error / *estimate.value; };
  const double before = relative_se(parameter(exact, "stiffness_N_per_m").estimate);
  CHECK(relative_se(parameter(uncertain, "stiffness_N_per_m").estimate) ==
        Approx(std::hypot(before, kSpeedError)).epsilon(1e-6));
  for (const char* name : {"natural_frequency_rad_per_s", "damping_ratio", "friction_difference_N"}) {
    INFO(name);
    CHECK(*parameter(uncertain, name).estimate.standard_error ==
          Approx(*parameter(exact, name).estimate.standard_error).epsilon(1e-9));
  }
}

TEST_CASE("sweep: a sensor at the contact is left out") {
  SweepScene scene;
  std::vector<SweepEntry> entries = test::record_sweep(scene, {0.005, 0.01});
  scene.view = ForceView::Contact;
  entries.push_back(test::record_sweep(scene, {0.02}).front());
  const SweepAnalysis sweep = analyze_sweep(entries);
  CHECK(sweep.roles[2] == SweepRole::LeftOut);
}

TEST_CASE("sweep: averages that no recording alone can tell are told by all of them together") {
  const SweepScene scene{.f0_N = 2.0, .f1_N = 0.0, .averaged = 4, .noise_N = 0.02};
  const std::vector<SweepEntry> entries = test::record_sweep(scene, kSpeeds);
  for (const SweepEntry& entry : entries)
    CHECK_FALSE(test::warns(analyze_and_fit(entry.recording).warnings, "samples_averaged"));
  const SweepAnalysis sweep = analyze_sweep(entries);
  REQUIRE(sweep.fit);
  CHECK(test::warns(sweep.fit->result.warnings, "samples_averaged"));
  const Parameter& frequency = parameter(sweep, "natural_frequency_rad_per_s");
  CHECK(frequency.status == ParameterStatus::Weak);
  CHECK(frequency.estimate.ci95->low <= scene.natural_frequency_rad_per_s);
  CHECK(frequency.estimate.ci95->high >= scene.natural_frequency_rad_per_s);
}

TEST_CASE("sweep: friction that goes on changing below the measured speeds leaves F_s - F_k(0+) open") {
  SweepScene scene;
  scene.law = model::LawShape::Logarithmic;
  scene.alpha_s_per_m = 1000.0 * -0.3;  // rate of the logarithm
  scene.f1_N = 0.1;
  const SweepAnalysis sweep = analyze_sweep(test::record_sweep(scene, kSpeeds));
  REQUIRE(sweep.fit);
  CHECK(sweep.fit->result.tier == Tier::Velocity);
  const Parameter& difference = parameter(sweep, "friction_difference_N");
  const double truth = scene.static_friction_N - scene.kinetic_friction_N();
  CHECK(difference.status == ParameterStatus::Weak);
  CHECK_THAT(difference.estimate.note, Catch::Contains("logarithmically"));
  CHECK(difference.estimate.ci95->low < truth);
  CHECK(difference.estimate.ci95->high > truth);
}

TEST_CASE("sweep: one speed cannot tell alpha, and says so") {
  const SweepAnalysis sweep = analyze_sweep(test::record_sweep({}, {0.01, 0.0105}));
  REQUIRE(sweep.fit);
  CHECK(sweep.fit->result.tier == Tier::Damped);
  CHECK_FALSE(parameter(sweep, "alpha_s_per_m").estimate.value);
  CHECK_THAT(parameter(sweep, "alpha_s_per_m").estimate.note, Catch::Contains("too little to determine alpha"));
}

TEST_CASE("sweep: recordings with zeros of their own share no level, and damping is then conditional") {
  SweepScene scene;
  scene.offset_N = 0.3;
  const SweepAnalysis sweep = analyze_sweep(test::record_sweep(scene, kSpeeds));
  REQUIRE(sweep.fit);
  CHECK_FALSE(sweep.fit->level_shared);
  CHECK(test::warns(sweep.fit->result.warnings, "level_differs"));
  CHECK(parameter(sweep, "damping_ratio").status != ParameterStatus::Identified);
  const Parameter& stiffness = parameter(sweep, "stiffness_N_per_m");
  CHECK(std::abs(*stiffness.estimate.value - scene.stiffness_N_per_m) < 4.0 * *stiffness.estimate.standard_error);
}

TEST_CASE("sweep: where recordings do not quite share k, F_k(v) stays because it predicts the unseen better") {
  const SweepScene scene{.f0_N = 1.0, .f1_N = 1.0};
  const std::vector<double> speeds{0.005, 0.01, 0.02, 0.04, 0.08, 0.12};
  const auto scene_of = [&](std::size_t i) {
    SweepScene s = scene;
    s.stiffness_N_per_m *= i == 1 || i == 2 ? 1.01 : 0.99;
    return s;
  };
  const SweepAnalysis sweep = analyze_sweep(record_each(speeds, scene_of));
  REQUIRE(sweep.fit);
  CHECK(*sweep.fit->result.residual.reduced_chi2 > 1.5);
  CHECK(sweep.fit->result.tier == Tier::Velocity);
  CHECK_THAT(sweep.fit->result.candidates.front().reason,
             Catch::Contains("spacing predicted for an omitted recording"));
  check_recovery(sweep, scene);
  const Estimate& slope = parameter(sweep, "friction_slope_N_s_per_m").estimate;
  const double truth = scene.f1_N * scene.alpha_s_per_m;
  CHECK(slope.ci95->low < truth);
  CHECK(truth < slope.ci95->high);
  for (const Parameter& p : sweep.fit->result.parameters) CHECK(p.status != ParameterStatus::Identified);
}

TEST_CASE("sweep: where recordings do not quite share w_n, F_k(v) gains and yet Coulomb friction predicts better") {
  const SweepScene scene{.f0_N = 2.0, .f1_N = 0.0};
  const auto scene_of = [&](std::size_t i) {
    SweepScene s = scene;
    s.natural_frequency_rad_per_s *= i == 1 || i == 2 ? 1.04 : 0.96;
    return s;
  };
  const SweepAnalysis sweep = analyze_sweep(record_each(kSpeeds, scene_of));
  REQUIRE(sweep.fit);
  CHECK(*sweep.fit->result.residual.reduced_chi2 > 1.5);
  CHECK(sweep.fit->result.tier == Tier::Damped);
  check_recovery(sweep, scene);
  const Parameter& alpha = parameter(sweep, "alpha_s_per_m");
  CHECK(alpha.status == ParameterStatus::Unidentified);
  CHECK_THAT(alpha.estimate.note, Catch::Contains("spacing predicted for an omitted recording"));
  for (const Parameter& p : sweep.fit->result.parameters) CHECK(p.status != ParameterStatus::Identified);
}

TEST_CASE("sweep: a kinetic friction that wanders from cycle to cycle is followed, and counts as scatter") {
  const SweepScene scene{.cycles = 40.0, .level_scatter_N = 0.08, .seed = 41};
  const SweepAnalysis sweep = analyze_sweep(test::record_sweep(scene, kSpeeds));
  REQUIRE(sweep.fit);
  CHECK(*sweep.fit->result.residual.reduced_chi2 == Approx(1.0).margin(0.1));
  check_recovery(sweep, scene);
  double count = 0.0;
  for (const Analysis& analysis : sweep.recordings) {
    double sum = 0.0, square = 0.0, cycles = 0.0;
    for (const Cycle& cycle : analysis.cycle_table) {
      if (!cycle.level_force) continue;
      const double off_N = *cycle.level_force - scene.kinetic_friction_N();
      sum += off_N;
      square += off_N * off_N;
      ++cycles;
    }
    count += cycles;
    CHECK(std::sqrt(square / cycles - sum * sum / cycles / cycles) == Approx(scene.level_scatter_N).epsilon(0.35));
  }
  const Estimate& slope = parameter(sweep, "friction_slope_N_s_per_m").estimate;
  CHECK(std::abs(*slope.value - scene.f1_N * scene.alpha_s_per_m) < 4.0 * *slope.standard_error);
  const Estimate& level = parameter(sweep, "kinetic_friction_N").estimate;
  CHECK(std::abs(*level.value - scene.kinetic_friction_N()) < 4.0 * *level.standard_error);
  CHECK(*level.standard_error > 0.7 * scene.level_scatter_N / std::sqrt(count));
}

TEST_CASE("sweep: where alpha is hardly told, intervals follow its valley to the other end") {
  // zeta times alpha is known, neither is: by its best values alone, with alpha > 0, this recording gave a slope of
  // -0.07 +- 0.06 N s/m and a difference of 1.105 +- 0.015 N.
  const SweepScene scene{.cycles = 40.0, .level_scatter_N = 0.08, .seed = 3700};
  const SweepAnalysis sweep = analyze_sweep(test::record_sweep(scene, {0.005, 0.01, 0.02, 0.04, 0.08}));
  REQUIRE(sweep.fit);
  const auto holds = [&](const char* name, double truth) {
    const Interval& ci = *parameter(sweep, name).estimate.ci95;
    return ci.low <= truth && truth <= ci.high;
  };
  CHECK(holds("friction_slope_N_s_per_m", scene.f1_N * scene.alpha_s_per_m));
  CHECK(holds("damping_ratio", scene.damping_ratio));
  CHECK(parameter(sweep, "alpha_s_per_m").status == ParameterStatus::Unidentified);
  const Estimate& difference = parameter(sweep, "friction_difference_N").estimate;
  CHECK(std::abs(*difference.value - (scene.static_friction_N - scene.kinetic_friction_N())) <
        4.0 * *difference.standard_error);
}

TEST_CASE("sweep: friction coefficients where the normal forces are stated, and differ") {
  const SweepScene scene;
  constexpr double kFirst_N = 4.0;
  constexpr double kMean_N = 5.0;
  const auto scene_at = [&](double load_N) {
    SweepScene s = scene;
    s.normal_force_N = load_N;
    s.static_friction_N *= load_N / kFirst_N;
    s.f0_N *= load_N / kFirst_N;
    s.f1_N *= load_N / kFirst_N;
    return s;
  };
  const auto scene_of = [&](std::size_t i) { return scene_at(i % 2 == 0 ? kFirst_N : 1.5 * kFirst_N); };
  const SweepAnalysis sweep = analyze_sweep(record_each(kSpeeds, scene_of));
  REQUIRE(sweep.fit);
  CHECK(std::ranges::count(sweep.fit->result.conditional_on, "normal force 5 N, the mean of the recordings") == 1);
  CHECK(sweep.fit->level_shared);
  check_recovery(sweep, scene_at(kMean_N));
  for (const auto& [name, truth] : {std::pair("mu0", scene.f0_N / kFirst_N), std::pair("mu1", scene.f1_N / kFirst_N)}) {
    const Parameter& p = parameter(sweep, name);
    INFO(name << " = " << *p.estimate.value << " +- " << *p.estimate.standard_error << ", truth " << truth);
    CHECK(p.status == ParameterStatus::Identified);
    CHECK(std::abs(*p.estimate.value - truth) < 4.0 * *p.estimate.standard_error);
    CHECK(*p.estimate.value == Approx(truth).epsilon(0.2));
  }
  // Kinetic friction of a recording is that under its own load.
  for (std::size_t i = 0; i < kSpeeds.size(); ++i) {
    const Estimate& friction = sweep.fit->points[i].kinetic_friction_N;
    const double load = i % 2 == 0 ? 1.0 : 1.5;
    const double truth_N = load * (scene.f0_N + scene.f1_N * std::exp(scene.alpha_s_per_m * kSpeeds[i]));
    CHECK(std::abs(*friction.value - truth_N) < 4.0 * *friction.standard_error);
  }
}

TEST_CASE("sweep: under Coulomb friction a steady recording is a value of F_k, and the law stays Coulomb's") {
  const SweepScene scene{.f0_N = 2.0, .f1_N = 0.0};
  std::vector<SweepEntry> entries = test::record_sweep(scene, {0.005, 0.01, 0.02});
  entries.push_back({"steady", steady_recording(scene.kinetic_friction_N(), scene.noise_N, 0.2, 81)});
  const SweepAnalysis sweep = analyze_sweep(entries);
  REQUIRE(sweep.fit);
  CHECK(sweep.fit->result.tier == Tier::Damped);
  check_recovery(sweep, scene);
}

TEST_CASE("in a sweep, too, a measured load that follows the force is in the mass") {
  // With F_k = mu F_n and F_n = F_n0 + s (F - F_0) the slips are those of a spring of k (1 - mu s): docs/model.md (31).
  constexpr double kShare = 0.15;
  constexpr double kLoad_N = 10.0;
  const SweepScene scene{.f1_N = 0.0};
  const std::vector<SweepEntry> plain = test::record_sweep(scene, kSpeeds);
  const double coefficient = scene.kinetic_friction_N() / kLoad_N;
  std::vector<SweepEntry> measured = plain;
  for (SweepEntry& entry : measured) {
    std::vector<double> load_N;
    for (const double one : entry.recording.force()) {
      load_N.push_back(kLoad_N + kShare / coefficient * (one - scene.kinetic_friction_N()));
    }
    entry.recording = test::with_conditions(entry.recording, entry.recording.conditions(), std::move(load_N));
  }
  const SweepAnalysis without = analyze_sweep(plain);
  const SweepAnalysis with = analyze_sweep(measured);
  CHECK(*parameter(with, "mass_kg").estimate.value ==
        Approx((1.0 - kShare) * *parameter(without, "mass_kg").estimate.value).epsilon(2e-3));
  for (const char* name : {"damping_ratio", "friction_difference_N"}) {
    INFO(name);
    CHECK(parameter(without, name).status == ParameterStatus::Identified);
    CHECK(parameter(with, name).status == ParameterStatus::Conditional);
  }
}

TEST_CASE("noise that is correlated may hide friction that depends on the speed: intervals include it") {
  // Under Coulomb friction zeta absorbs the law: of 55 sweeps 24 intervals of zeta held the truth, now 52.
  int found = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    SweepScene s;
    s.seed = seed;
    s.alpha_s_per_m = -2.0;
    s.noise_N = 1e-4;
    s.scatter_N = 0.02;
    std::vector<SweepEntry> entries = record_sweep(s, kSpeeds);
    std::uint64_t of_noise = 10 * seed;
    for (SweepEntry& entry : entries) {
      entry.recording = test::with_correlated_noise(entry.recording, 0.01, ++of_noise);
    }
    const SweepAnalysis sweep = analyze_sweep(entries);
    REQUIRE(sweep.fit);
    CAPTURE(seed);
    const Interval zeta = parameter(sweep, "damping_ratio").estimate.ci95.value_or(Interval{0.0, 1.0});
    CHECK(zeta.low <= s.damping_ratio);
    CHECK(zeta.high >= s.damping_ratio);
    found += sweep.fit->result.tier == Tier::Velocity ? 1 : 0;
  }
  CHECK(found < 3);  // or this shows nothing
}
