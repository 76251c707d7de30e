#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "scene.hpp"
#include "support/holds.hpp"
#include "support/recordings.hpp"

namespace slipfit {
namespace {

constexpr double kTrueStiffness = 500.0, kTrueOmega = 120.0, kZeta = 0.06, kSpeed = 0.01;

using CourseOf = std::function<double(double share)>;  ///< of time, 0 to 1

/// A body on a spring, integrated in small steps. `friction`: factor of static (2 N) and kinetic friction (1.4 N), or
/// of static friction alone where `kinetic` is the factor of the other; `sensor`: what is added to the force.
Recording slide(const CourseOf& friction, const CourseOf& sensor, std::vector<double>* load_N = nullptr,
                const CourseOf& kinetic = {}) {
  constexpr double kDuration_s = 8.0, kStep_s = 1e-3;
  constexpr int kSubsteps = 50;
  const double mass = kTrueStiffness / (kTrueOmega * kTrueOmega);
  const double damping = 2.0 * kZeta * kTrueOmega * mass;
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 0.005);
  std::vector<double> time_s, force;
  double extension_m = 1.4 / kTrueStiffness;
  double velocity = 0.0;  // of the body
  bool sticks = true;
  for (double t = 0.0; t < kDuration_s; t += kStep_s) {
    const double factor = friction(t / kDuration_s);
    const double kinetic_N = 1.4 * (kinetic ? kinetic(t / kDuration_s) : factor);
    for (int i = 0; i < kSubsteps; ++i) {
      const double pull = kTrueStiffness * extension_m + damping * (kSpeed - velocity);
      if (sticks && pull > 2.0 * factor) sticks = false;
      if (!sticks) velocity += (pull - kinetic_N) / mass * kStep_s / kSubsteps;
      if (velocity <= 0.0 && !sticks) {
        velocity = 0.0;
        sticks = kTrueStiffness * extension_m + damping * kSpeed < 2.0 * factor;
      }
      extension_m += (kSpeed - velocity) * kStep_s / kSubsteps;
    }
    time_s.push_back(t + kStep_s);
    force.push_back(kTrueStiffness * extension_m + sensor(t / kDuration_s) + noise(random));
    if (load_N != nullptr) load_N->push_back(5.0 * factor);
  }
  Conditions conditions;
  conditions.speed_m_per_s = kSpeed;
  conditions.zero_force_N = 0.0;
  return Recording::create(std::move(time_s), std::move(force), conditions).value();
}

Recording with(const Recording& recording, LevelReading drift, std::vector<double> load_N = {}) {
  Conditions conditions = recording.conditions();
  conditions.drift = drift;
  return test::with_conditions(recording, conditions, std::move(load_N));
}

const CourseOf kConstant = [](double) { return 1.0; };
const CourseOf kNothing = [](double) { return 0.0; };

}  // namespace

TEST_CASE("a damping ratio that rests on slips that scatter says how low it is if kinetic friction follows static") {
  constexpr double kFollowed = 0.1;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0.0, 0.02);
  std::vector<double> spots(33);
  for (double& spot : spots) spot = normal(random);
  const auto spot = [&](double share) { return spots[static_cast<std::size_t>(32.0 * share)]; };
  const Analysis analysis =
      analyze_and_fit(slide([&](double share) { return 1.0 + spot(share); }, kNothing, nullptr,
                            [&](double share) { return 1.0 + kFollowed * 2.0 / 1.4 * spot(share); }));
  const Parameter& zeta = parameter(analysis, "damping_ratio");
  CHECK_FALSE(test::holds(zeta.estimate, kZeta));
  CHECK(zeta.status == ParameterStatus::Conditional);
  const std::string says = "if it follows a tenth of the scatter of F_s, zeta may be as low as ";
  const std::size_t at = zeta.estimate.note.find(says);
  REQUIRE(at != std::string::npos);
  const double lowest = std::stod(zeta.estimate.note.substr(at + says.size()));
  CHECK(lowest < kZeta);
  CHECK(lowest == Approx(kZeta).margin(0.03));  // the shape of the slips holds zeta back

  const Analysis regular = analyze_and_fit(slide(kConstant, kNothing));
  CHECK(parameter(regular, "damping_ratio").estimate.note.find(says) == std::string::npos);
}

TEST_CASE("the interval of k includes both readings of a trend of the level") {
  const auto of_friction = [&](double share) { return 1.0 + 0.8 * share; };
  const Recording recording = slide(of_friction, kNothing);
  const Analysis open = analyze_and_fit(recording);
  REQUIRE(open.fit);
  const LevelTrend& trend = open.fit->level_trend;
  CHECK(trend.reading == LevelReading::Open);
  CHECK(*trend.rate_per_s.value == Approx(0.8 * 1.4 / 8.0).epsilon(0.05));
  CHECK(test::holds(open.fit->stiffness(), kTrueStiffness));
  CHECK(has_warning(open, "level_trend"));
  CHECK(parameter(open, "static_friction_N").status != ParameterStatus::Identified);

  const Analysis friction = analyze_and_fit(with(recording, LevelReading::Friction));
  CHECK(test::holds(friction.fit->stiffness(), kTrueStiffness));
  CHECK(parameter(friction, "stiffness_N_per_m").status == ParameterStatus::Identified);
  const Analysis sensor = analyze_and_fit(with(recording, LevelReading::Sensor));
  CHECK_FALSE(test::holds(sensor.fit->stiffness(), kTrueStiffness));
  CHECK(*friction.fit->stiffness().value - *sensor.fit->stiffness().value ==
        Approx(*trend.rate_per_s.value / kSpeed).epsilon(0.02));
}

TEST_CASE("a drift of the sensor is in the interval of k, and its start in that of static friction") {
  const Recording recording = slide(kConstant, [](double share) { return 1.6 * share; });
  const Analysis open = analyze_and_fit(recording);
  REQUIRE(open.fit);
  CHECK(test::holds(open.fit->stiffness(), kTrueStiffness));
  CHECK(test::holds(parameter(open, "static_friction_N").estimate, 2.0));
  CHECK(parameter(open, "static_friction_N").status != ParameterStatus::Identified);
  const Analysis sensor = analyze_and_fit(with(recording, LevelReading::Sensor));
  CHECK(test::holds(sensor.fit->stiffness(), kTrueStiffness));
  CHECK(sensor.fit->stiffness().ci95->high < open.fit->stiffness().ci95->high);
}

TEST_CASE("sticks that follow a bent level, or do not, decide the reading") {
  const auto decay = [](double share) { return std::exp(-3.0 * share); };
  SECTION("run-in") {
    const Analysis run_in = analyze_and_fit(slide([&](double s) { return 1.0 + 0.3 * decay(s); }, kNothing));
    REQUIRE(run_in.fit);
    CHECK(run_in.fit->level_trend.reading == LevelReading::Friction);
    CHECK(test::holds(run_in.fit->stiffness(), kTrueStiffness));
  }
  SECTION("a sensor that settles") {
    const Analysis settles = analyze_and_fit(slide(kConstant, [&](double s) { return 1.2 * decay(s); }));
    REQUIRE(settles.fit);
    CHECK(settles.fit->level_trend.reading == LevelReading::Sensor);
    CHECK(test::holds(settles.fit->stiffness(), kTrueStiffness));
  }
}

TEST_CASE("a load that was measured decides the reading where it explains the trend") {
  std::vector<double> load_N;
  const Recording recording = slide([](double share) { return 1.0 + 0.8 * share; }, kNothing, &load_N);
  const Analysis by_load = analyze_and_fit(with(recording, LevelReading::Open, load_N));
  REQUIRE(by_load.fit);
  CHECK(by_load.fit->level_trend.reading == LevelReading::Friction);
  CHECK(test::holds(by_load.fit->stiffness(), kTrueStiffness));
  CHECK(by_load.fit->stiffness().ci95->low > 0.98 * kTrueStiffness);
  const Analysis steady =
      analyze_and_fit(with(recording, LevelReading::Open, std::vector<double>(recording.size(), 5.0)));
  CHECK(steady.fit->level_trend.reading == LevelReading::Open);
}

TEST_CASE("a level without a trend has no reading, and changes nothing") {
  const Recording recording = slide(kConstant, kNothing);
  const Analysis open = analyze_and_fit(recording);
  REQUIRE(open.fit);
  CHECK_FALSE(open.fit->level_trend.level_range);
  CHECK_FALSE(has_warning(open, "level_trend"));
  const Analysis stated = analyze_and_fit(with(recording, LevelReading::Friction));
  CHECK(*stated.fit->stiffness().value == *open.fit->stiffness().value);
  CHECK(stated.fit->stiffness().ci95->high == open.fit->stiffness().ci95->high);
  CHECK(parameter(open, "static_friction_N").status == ParameterStatus::Identified);
}

}  // namespace slipfit
