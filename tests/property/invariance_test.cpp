// What cannot matter does not change the answer: zero, sign and unit of the force, speed and start of the clock, a few
// lost samples. invariance_study does the same with all recordings at hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "families.hpp"
#include "invariance.hpp"
#include "slipfit/io/recording_reader.hpp"

using namespace slipfit;
using test::Scene;

namespace {

Scene scene_of(const Recording& recording) {
  const auto time_s = recording.time_s();
  const auto force = recording.force();
  Scene scene{"", {time_s.begin(), time_s.end()}, {force.begin(), force.end()}, recording.conditions()};
  scene.conditions.zero_force_N.reset();
  return scene;
}

/// Weak interference is looked for at multiples of 50 and 60 Hz alone: a stretched clock moves the mains away from
/// them.
enum class Mains { Absent, Present };

void check_invariant(const Scene& scene, Mains mains = Mains::Absent) {
  const Analysis plain = test::analyse_as_read(scene);
  for (const test::Transform& transform : test::invariances(17)) {
    if (mains == Mains::Present && transform.name.starts_with("clock times")) continue;
    CAPTURE(transform.name);
    const Analysis found = test::analyse_as_read(transform.change(scene));
    CHECK(test::differences(plain, found, transform).text() == "");
  }
}

/// Swings of 5 % of the mean force whose periods scatter: an oscillation on a large level.
Scene swings_on_a_level() {
  std::mt19937_64 generator(5);
  Scene scene{"", {}, {}, {}};
  scene.conditions.speed_m_per_s = 0.01;
  double phase = 0.0;
  double rate = 1.0;
  for (std::size_t i = 0; i < 6000; ++i) {
    if (i % 200 == 0) rate = 0.9 + 0.2 * static_cast<double>(generator() % 1000) / 1000.0;
    phase += 2.0 * M_PI * 50.0 / 5000.0 * rate;
    const double noise = static_cast<double>(generator() % 2000) / 1000.0 - 1.0;
    scene.time_s.push_back(static_cast<double>(i) / 5000.0);
    scene.force_N.push_back(40.0 + std::sin(phase) + 0.01 * noise);
  }
  return scene;
}

}  // namespace

TEST_CASE("the demo, with drift and hum, gives the same answer whatever cannot matter") {
  Conditions conditions;
  conditions.speed_m_per_s = 0.01;
  check_invariant(scene_of(read_recording(SLIPFIT_TESTDATA_DIR "/demo.csv", conditions).value()), Mains::Present);
}

TEST_CASE("random stick-slip gives the same answer whatever cannot matter") {
  Scene scene = test::random_scene(GENERATE(range(std::uint64_t{831}, std::uint64_t{834})));
  CAPTURE(scene.described);
  scene.conditions.zero_force_N.reset();
  check_invariant(scene);
}

TEST_CASE("stick-slip with much hum gives the same answer whatever cannot matter, the clock included") {
  check_invariant(scene_of(coverage::make_scene("defect", 7, 7).recording));
}

TEST_CASE("a ring-down at twice the frequency of the mains gives the same answer at any speed of the clock") {
  check_invariant(scene_of(coverage::make_scene("ringdown", 2, 7).recording));
}

TEST_CASE("swings that are small against the mean force are judged alike whatever the zero") {
  const Scene scene = swings_on_a_level();
  CHECK(test::analyse_as_read(scene).motion == MotionClass::OscillatorySlip);
  check_invariant(scene);
}

TEST_CASE("time stamps rounded to five samples give the same answer") {
  Conditions conditions;
  conditions.speed_m_per_s = 0.01;
  const Scene scene = scene_of(read_recording(SLIPFIT_TESTDATA_DIR "/demo.csv", conditions).value());
  Scene rounded = scene;
  for (double& time_s : rounded.time_s) time_s = std::round(1000.0 * time_s) / 1000.0;
  const test::Transform same{"", nullptr, {}, 0.3};
  const auto differences = test::differences(test::analyse_as_read(scene), test::analyse_as_read(rounded), same);
  CHECK(differences.text() == "");
}
