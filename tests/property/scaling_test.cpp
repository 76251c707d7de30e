// What must hold for every recording: units are a convention, clocks and zeros are arbitrary.
#include <catch2/catch.hpp>
#include <cstddef>

#include "scenes.hpp"

using namespace slipfit;
using test::Factors;
using test::Scene;

namespace {

constexpr std::uint64_t kFirstScaled = 801;
constexpr std::uint64_t kLastScaled = 808;

Scene with_force(Scene scene, double factor) {
  for (double& force : scene.force_N) force *= factor;
  return scene;
}

Scene with_clock(Scene scene, double factor, double start_s) {
  for (double& time : scene.time_s) time = start_s + factor * time;
  return scene;
}

Scene every_second_sample(const Scene& scene) {
  Scene thinned{scene.described, {}, {}, scene.conditions};
  for (std::size_t i = 0; i < scene.time_s.size(); i += 2) {
    thinned.time_s.push_back(scene.time_s[i]);
    thinned.force_N.push_back(scene.force_N[i]);
  }
  return thinned;
}

enum class Half { First, Second };

Scene half(const Scene& scene, Half which) {
  const auto middle = static_cast<std::ptrdiff_t>(scene.time_s.size() / 2);
  const auto cut = [&](const std::vector<double>& values) {
    return which == Half::Second ? std::vector<double>(values.begin() + middle, values.end())
                                 : std::vector<double>(values.begin(), values.begin() + middle);
  };
  return {scene.described, cut(scene.time_s), cut(scene.force_N), scene.conditions};
}

}  // namespace

TEST_CASE("all forces times a: stiffness, friction and mass times a, all else as before") {
  const std::uint64_t seed = GENERATE(range(kFirstScaled, kLastScaled + 1));
  const double a = GENERATE(0.001, 1024.0);
  const Scene scene = test::random_scene(seed);
  CAPTURE(scene.described, a);
  const Factors factors{{"stiffness_N_per_m", a},  {"friction_difference_N", a},         {"static_friction_N", a},
                        {"kinetic_friction_N", a}, {"damping_coefficient_N_s_per_m", a}, {"mass_kg", a}};
  test::check_same(test::analyse(scene), test::analyse(with_force(scene, a)), factors);
}

TEST_CASE("all times times b at the same speed: stiffness and natural frequency over b, mass times b") {
  const std::uint64_t seed = GENERATE(range(kFirstScaled, kLastScaled + 1));
  const double b = GENERATE(0.01, 128.0);
  const Scene scene = test::random_scene(seed);
  CAPTURE(scene.described, b);
  const Factors factors{{"stiffness_N_per_m", 1.0 / b}, {"natural_frequency_rad_per_s", 1.0 / b}, {"mass_kg", b}};
  test::check_same(test::analyse(scene), test::analyse(with_clock(scene, b, 0.0)), factors);
}

TEST_CASE("the speed times c for the same trace: stiffness, damping coefficient and mass over c") {
  const std::uint64_t seed = GENERATE(range(kFirstScaled, kLastScaled + 1));
  const double c = GENERATE(0.001, 1000.0);
  const Scene scene = test::random_scene(seed);
  CAPTURE(scene.described, c);
  Scene faster = scene;
  faster.conditions.speed_m_per_s *= c;
  const Factors factors{
      {"stiffness_N_per_m", 1.0 / c}, {"damping_coefficient_N_s_per_m", 1.0 / c}, {"mass_kg", 1.0 / c}};
  test::check_same(test::analyse(scene), test::analyse(faster), factors);
}

TEST_CASE("a clock that starts at another time changes nothing") {
  const std::uint64_t seed = GENERATE(range(kFirstScaled, kLastScaled + 1));
  const double start_s = GENERATE(-7.25, 1000.0);
  const Scene scene = test::random_scene(seed);
  CAPTURE(scene.described, start_s);
  test::check_same(test::analyse(scene), test::analyse(with_clock(scene, 1.0, start_s)));
}

TEST_CASE("half the sampling rate: the same parameters within their intervals") {
  const Scene scene = test::random_scene(GENERATE(range(kFirstScaled, kLastScaled + 1)));
  CAPTURE(scene.described);
  test::check_agree(test::analyse(scene), test::analyse(every_second_sample(scene)));
}

TEST_CASE("both halves of a recording: the same parameters within their intervals") {
  const Scene scene = test::random_scene(GENERATE(range(kFirstScaled, kLastScaled + 1)));
  CAPTURE(scene.described);
  test::check_agree(test::analyse(half(scene, Half::First)), test::analyse(half(scene, Half::Second)));
}
