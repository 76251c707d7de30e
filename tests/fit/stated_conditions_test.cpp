#include <catch2/catch.hpp>
#include <cmath>

#include "scene.hpp"
#include "support/recordings.hpp"

using namespace slipfit;

namespace {

double relative_se(const Estimate& estimate) {
  return *estimate.standard_error / *estimate.value;
}

}  // namespace

TEST_CASE("an uncertain speed is in k, mass, c and the spacing, and in nothing else") {
  const double speed_error = GENERATE(0.01, 0.1);
  const ForceView view = GENERATE(ForceView::Spring, ForceView::Contact);
  Scene s{.samples_per_slip = 31.7, .jitter = 0.05, .noise = 0.01, .view = view};
  s.conditions.sensor_average_s = 0.0;  // what averaging may have done does not add as a square
  const Analysis exact = analyze_and_fit(record(s));
  s.conditions.speed_standard_error_m_per_s = speed_error * s.speed;
  const Analysis uncertain = analyze_and_fit(record(s));
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
  // It lies far from V: what one speed does not know of others adds to it, and not as a square.
  CHECK(relative_se(uncertain.derived.critical_speed_m_per_s) > relative_se(exact.derived.critical_speed_m_per_s));
  // What predictions at other speeds start from.
  CHECK(uncertain.fit->estimate->covariance[0][0] ==
        Approx(exact.fit->estimate->covariance[0][0] + speed_error * speed_error).epsilon(1e-9));
}

TEST_CASE("a stated mass is held against k / w_n^2 and never forced") {
  Scene s;
  s.noise = 0.01;
  const double mass_kg = s.stiffness / (s.omega * s.omega);
  const Analysis unstated = analyze_and_fit(record(s));
  s.conditions.mass_kg = mass_kg;
  CHECK_FALSE(has_warning(analyze_and_fit(record(s)), "mass_differs"));
  s.conditions.mass_kg = 1.5 * mass_kg;
  const Analysis contradicted = analyze_and_fit(record(s));
  CHECK(has_warning(contradicted, "mass_differs"));
  CHECK(*parameter(contradicted, "mass_kg").estimate.value == *parameter(unstated, "mass_kg").estimate.value);
}

TEST_CASE("slips near the load cell's resonance are warned of") {
  Scene s;
  s.noise = 0.01;
  const double natural_Hz = s.omega / 6.283185307;
  s.conditions.sensor_resonance_Hz = 2.0 * natural_Hz;
  CHECK(has_warning(analyze_and_fit(record(s)), "near_sensor_resonance"));
  s.conditions.sensor_resonance_Hz = 20.0 * natural_Hz;
  CHECK_FALSE(has_warning(analyze_and_fit(record(s)), "near_sensor_resonance"));
}

TEST_CASE("one recording says that it takes the stated speed and Coulomb friction for granted") {
  Scene s{.jitter = 0.05, .noise = 0.01};
  const Analysis taken = analyze_and_fit(record(s));
  REQUIRE(taken.fit->conditional_on.size() == 3);
  CHECK_THAT(taken.fit->conditional_on[1], Catch::Contains("stated driving speed"));
  for (const char* name :
       {"friction_difference_N", "damping_ratio", "damping_coefficient_N_s_per_m", "kinetic_friction_N"}) {
    INFO(name);
    CHECK(parameter(taken, name).status == ParameterStatus::Conditional);
    CHECK_FALSE(parameter(taken, name).estimate.note.empty());
  }
  CHECK(parameter(taken, "static_friction_N").status == ParameterStatus::Identified);  // the zero is stated
  s.conditions.speed_standard_error_m_per_s = 0.01 * s.speed;
  CHECK(analyze_and_fit(record(s)).fit->conditional_on.size() == 2);
}

TEST_CASE("w_n and m take friction and load within a slip for granted, unless a stated mass agrees with them") {
  Scene s{.jitter = 0.05, .noise = 0.01};
  const double mass_kg = s.stiffness / (s.omega * s.omega);
  const auto status_with = [&](std::optional<double> stated_kg, const char* name) {
    s.conditions.mass_kg = stated_kg;
    return parameter(analyze_and_fit(record(s)), name).status;
  };
  for (const char* name : {"natural_frequency_rad_per_s", "mass_kg"}) {
    INFO(name);
    CHECK(status_with(std::nullopt, name) == ParameterStatus::Conditional);
    CHECK(status_with(mass_kg, name) == ParameterStatus::Identified);
    CHECK(status_with(1.5 * mass_kg, name) != ParameterStatus::Identified);
  }
}

TEST_CASE("a measured load that follows the force is in the mass") {
  // With F_k = mu F_n and F_n = F_n0 + s (F - F_0) the slips are those of a spring of k (1 - mu s): docs/model.md (31).
  const Scene s{.noise = 0.01};
  const Recording plain = record(s);
  constexpr double kLoad_N = 10.0;
  const double coefficient = s.kinetic_N / kLoad_N;
  const double share = GENERATE(-0.15, 0.0, 0.15);
  CAPTURE(share);
  std::vector<double> load_N;
  for (const double force : plain.force()) load_N.push_back(kLoad_N + share / coefficient * (force - s.kinetic_N));
  const Estimate without = parameter(analyze_and_fit(plain), "mass_kg").estimate;
  const Estimate with =
      parameter(analyze_and_fit(test::with_conditions(plain, plain.conditions(), load_N)), "mass_kg").estimate;
  CHECK(*with.value == Approx((1.0 - share) * *without.value).epsilon(2e-3));
  CHECK(with.ci95->high > with.ci95->low);
}

TEST_CASE("averaging over a step of the clock lengthens the side of the interval that it would move") {
  Scene s{.jitter = 0.05, .noise = 0.01};
  const Interval open = *parameter(analyze_and_fit(record(s)), "natural_frequency_rad_per_s").estimate.ci95;
  s.conditions.sensor_average_s = 0.0;
  const Interval instant = *parameter(analyze_and_fit(record(s)), "natural_frequency_rad_per_s").estimate.ci95;
  CHECK(open.low == Approx(instant.low).epsilon(1e-12));
  // 0.62 (w_n step)^2 / 12 of w_n, docs/model.md section 7; damping and force ratio are not quite those of the rule.
  const Recording recording = record(s);
  const double expected = 0.62 * std::pow(s.omega * recording.sample_interval_s(), 2) / 12.0;
  CHECK(std::log(open.high / instant.high) == Approx(expected).epsilon(0.3));
}

TEST_CASE("with few samples in a slip the interval of w_n allows for averaging over one of them, unless it is stated") {
  Scene s{.samples_per_slip = 6.0, .jitter = 0.05, .noise = 0.005};
  const Estimate open = parameter(analyze_and_fit(record(s)), "natural_frequency_rad_per_s").estimate;
  s.conditions.sensor_average_s = 0.0;
  const Estimate instant = parameter(analyze_and_fit(record(s)), "natural_frequency_rad_per_s").estimate;
  s.conditions.sensor_average_s = record(s).sample_interval_s();
  const Estimate averaged = parameter(analyze_and_fit(record(s)), "natural_frequency_rad_per_s").estimate;
  CHECK(open.ci95->low == Approx(instant.ci95->low).epsilon(1e-3));
  CHECK(open.ci95->high > 1.002 * instant.ci95->high);
  CHECK(open.ci95->high < 0.3 * instant.ci95->high + 0.7 * averaged.ci95->high);  // the slips show that there is none
}
