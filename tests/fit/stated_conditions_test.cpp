#include <catch2/catch.hpp>
#include <cmath>

#include "scene.hpp"

using namespace slipfit;

namespace {

double relative_se(const Estimate& estimate) {
  return *estimate.standard_error / *estimate.value;
}

}  // namespace

TEST_CASE("an uncertain speed is in k, mass, c and the spacing, and in nothing else") {
  const double speed_error = GENERATE(0.01, 0.1);
  const ForceView view = GENERATE(ForceView::Spring, ForceView::Contact);
  Scene s;
  s.noise = 0.01;
  s.jitter = 0.05;
  s.samples_per_slip = 31.7;
  s.view = view;
  const Analysis exact = analyze_and_fit(record(s), {});
  s.conditions.speed_standard_error_m_per_s = speed_error * s.speed;
  const Analysis uncertain = analyze_and_fit(record(s), {});
  for (const char* name : {"stiffness_N_per_m", "mass_kg", "damping_coefficient_N_s_per_m"}) {
    INFO(name);
    const double before = relative_se(parameter(exact, name).estimate);
    CHECK(relative_se(parameter(uncertain, name).estimate) == Approx(std::hypot(before, speed_error)).epsilon(1e-6));
  }
  for (const char* name : {"friction_difference_N", "natural_frequency_rad_per_s", "damping_ratio"}) {
    INFO(name);
    CHECK(*parameter(uncertain, name).estimate.standard_error == *parameter(exact, name).estimate.standard_error);
  }
  // k V is measured: lambda does not hang on V; distances and the critical speed go as V.
  CHECK(*uncertain.derived.lambda.standard_error == Approx(*exact.derived.lambda.standard_error).epsilon(1e-9));
  const auto check_distance = [&](const Estimate& with, const Estimate& without) {
    REQUIRE(with.standard_error);
    CHECK(relative_se(with) == Approx(std::hypot(relative_se(without), speed_error)).epsilon(1e-6));
  };
  check_distance(uncertain.derived.pattern_spacing_m, exact.derived.pattern_spacing_m);
  check_distance(uncertain.derived.periodic_displacement_m, exact.derived.periodic_displacement_m);
  check_distance(uncertain.derived.micro_vibration_spacing_m, exact.derived.micro_vibration_spacing_m);
  check_distance(uncertain.derived.critical_speed_m_per_s, exact.derived.critical_speed_m_per_s);
  // What predictions at other speeds start from.
  CHECK(uncertain.fit->estimate->covariance[0][0] ==
        Approx(exact.fit->estimate->covariance[0][0] + speed_error * speed_error).epsilon(1e-9));
}

TEST_CASE("a stated mass is held against k / w_n^2 and never forced") {
  Scene s;
  s.noise = 0.01;
  const double mass_kg = s.stiffness / (s.omega * s.omega);
  const Analysis unstated = analyze_and_fit(record(s), {});
  s.conditions.mass_kg = mass_kg;
  CHECK_FALSE(has_warning(analyze_and_fit(record(s), {}), "mass_differs"));
  s.conditions.mass_kg = 1.5 * mass_kg;
  const Analysis contradicted = analyze_and_fit(record(s), {});
  CHECK(has_warning(contradicted, "mass_differs"));
  CHECK(*parameter(contradicted, "mass_kg").estimate.value == *parameter(unstated, "mass_kg").estimate.value);
}

TEST_CASE("slips near the load cell's resonance are warned of") {
  Scene s;
  s.noise = 0.01;
  const double natural_Hz = s.omega / 6.283185307;
  s.conditions.sensor_resonance_Hz = 2.0 * natural_Hz;
  CHECK(has_warning(analyze_and_fit(record(s), {}), "near_sensor_resonance"));
  s.conditions.sensor_resonance_Hz = 20.0 * natural_Hz;
  CHECK_FALSE(has_warning(analyze_and_fit(record(s), {}), "near_sensor_resonance"));
}
