#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "scene.hpp"
#include "support/holds.hpp"
#include "support/recordings.hpp"

using namespace slipfit;

namespace {

void check_recovery(const Scene& s, ParameterStatus of_frequency = ParameterStatus::Conditional) {
  const Analysis analysis = analyze_and_fit(record(s));
  INFO(analysis.motion_reason);
  REQUIRE(analysis.motion == MotionClass::StickSlip);
  check_truth(analysis, s);
  CHECK(parameter(analysis, "stiffness_N_per_m").status == ParameterStatus::Identified);
  CHECK(parameter(analysis, "natural_frequency_rad_per_s").status == of_frequency);
}

}  // namespace

TEST_CASE("the fit returns what was simulated, within its own standard errors") {
  Scene s;
  s.noise = 0.01;
  SECTION("regular cycles") {
    check_recovery(s);
  }
  SECTION("scattering static friction") {
    s.jitter = 0.1;
    check_recovery(s);
  }
  SECTION("drift of twice the drop") {
    s.jitter = 0.05;
    s.drift_over_drop = 2.0;
    check_recovery(s);
  }
  SECTION("hum smaller than the noise, beside a line of the cycles") {
    s.jitter = 0.05;
    s.hum = 0.007;  // unmodelled it moves k by 5 standard errors and more
    check_recovery(s);
  }
  SECTION("hum ten times the noise") {
    s.hum = 0.1;
    check_recovery(s);
  }
  SECTION("short sticks, just above the limit") {
    s.zeta = 0.1;
    s.speed = s.omega * (s.static_N - s.kinetic_N) / (s.stiffness * 1.1 * critical_lambda(s.zeta));
    check_recovery(s);
  }
  SECTION("transmitted force") {
    s.view = ForceView::Transmitted;
    s.speed = 0.05;
    check_recovery(s);
  }
}

TEST_CASE("a sensor at the contact: jumps and plateaus give all four parameters") {
  Scene s{.noise = 0.01, .view = ForceView::Contact};
  SECTION("regular, not in step with the clock") {
    s.samples_per_slip = 31.7;
    check_recovery(s, ParameterStatus::Identified);  // the plateaus show the friction of the slips
  }
  SECTION("scattering static friction") {
    s.jitter = 0.08;
    check_recovery(s, ParameterStatus::Identified);  // the plateaus show the friction of the slips
  }
  SECTION("drift of twice the drop") {
    s.drift_over_drop = 2.0;
    check_recovery(s, ParameterStatus::Identified);  // the plateaus show the friction of the slips
  }
}

TEST_CASE("the interval of the spacing knows that neighbouring periods scatter together") {
  int inside = 0;
  constexpr int kRecordings = 60;
  for (int i = 1; i <= kRecordings; ++i) {
    Scene s{.zeta = 0.01, .jitter = 0.1, .noise = 0.005, .seed = static_cast<std::uint64_t>(i)};
    const Analysis analysis = analyze_and_fit(record(s));
    s.jitter = 0.0;
    const LimitCycle cycle = *damped_motion(Slider::create(s.stiffness, s.omega, s.zeta).value(),
                                            Friction::create(s.static_N, s.kinetic_N).value(), s.speed)
                                  .cycle;
    REQUIRE(analysis.derived.pattern_spacing_m.ci95);
    inside += test::holds(analysis.derived.pattern_spacing_m, cycle.periodic_displacement_m) ? 1 : 0;
  }
  // At 95 % fewer than 52 of 60 have a chance of 1 %; independent periods would give 83 %, 50 of 60.
  INFO(inside << " of " << kRecordings);
  CHECK(inside >= 52);
}

TEST_CASE("95 % intervals hold the truth about 95 times in 100") {
  int inside = 0;
  int given = 0;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    std::mt19937_64 random(seed);
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    Scene s;
    s.zeta = uniform(0.01, 0.12);
    s.speed = s.omega * 0.6 / (s.stiffness * uniform(3.0, 60.0));
    s.samples_per_slip = uniform(20.0, 50.0);
    s.cycles = uniform(15.0, 40.0);
    s.jitter = seed % 2 == 0 ? uniform(0.02, 0.15) : 0.0;
    s.noise = uniform(0.003, 0.03);
    s.seed = seed;
    const Analysis analysis = analyze_and_fit(record(s));
    REQUIRE(analysis.motion == MotionClass::StickSlip);
    const std::pair<const char*, double> truths[] = {{"stiffness_N_per_m", s.stiffness},
                                                     {"natural_frequency_rad_per_s", s.omega},
                                                     {"friction_difference_N", s.static_N - s.kinetic_N},
                                                     {"damping_ratio", s.zeta}};
    for (const auto& [name, truth] : truths) {
      const Estimate& estimate = parameter(analysis, name).estimate;
      REQUIRE(estimate.ci95);
      ++given;
      inside += test::holds(estimate, truth) ? 1 : 0;
    }
  }
  // 100 intervals at 95 %, F_s - F_k and zeta of a recording missing together: 87 has a chance below 1 %.
  INFO(inside << " of " << given);
  CHECK(inside >= 87);
}

TEST_CASE("what a slip of one sample cannot tell is bounded or unidentified") {
  const Scene s{.zeta = 0.08, .speed = 0.001, .samples_per_slip = 0.9, .noise = 0.01};
  const Analysis analysis = analyze_and_fit(record(s));
  REQUIRE(analysis.fit);
  CHECK(analysis.motion == MotionClass::StickSlip);
  CHECK(parameter(analysis, "damping_ratio").status == ParameterStatus::Unidentified);
  CHECK_FALSE(parameter(analysis, "damping_ratio").estimate.value);
  const Parameter& difference = parameter(analysis, "friction_difference_N");
  CHECK(difference.status == ParameterStatus::Bounded);
  CHECK(difference.estimate.ci95->low < 0.6);
  CHECK(difference.estimate.ci95->high > 0.6);
  check_truth(analysis, "stiffness_N_per_m", s.stiffness);
}

TEST_CASE("below the stick-slip limit the motion rings down, and no parameter is claimed") {
  Scene s;
  s.zeta = 0.04;
  s.speed = s.omega * 0.6 / (s.stiffness * 0.6 * critical_lambda(s.zeta));
  s.noise = 0.005;
  const Slider slider = Slider::create(s.stiffness, s.omega, s.zeta).value();
  const Friction friction = Friction::create(s.static_N, s.kinetic_N).value();
  REQUIRE_FALSE(damped_motion(slider, friction, s.speed).cycle);
  const SimulationOptions options{.duration_s = 1.6, .sample_rate_Hz = 1000.0, .noise_rms_N = 0.005};
  SimulatedTrace trace = simulate(slider, friction, s.speed, options);
  const Analysis analysis =
      analyze_and_fit(test::recording_of(std::move(trace.time_s), std::move(trace.force_N), s.speed));
  CHECK(analysis.motion != MotionClass::StickSlip);
  if (!analysis.fit) return;
  for (const Parameter& p : analysis.fit->parameters) CHECK(p.status == ParameterStatus::Unidentified);
}

TEST_CASE("sticks that bend widen the interval of the stiffness and are warned of") {
  const Scene s{.jitter = 0.05, .noise = 0.005};
  const Recording straight = record(s);
  std::vector<double> force(straight.force().begin(), straight.force().end());
  // Creep: a soft ceiling that the force approaches, so that each stick flattens towards its end.
  for (double& f : force) f -= 0.15 * (f - 0.9) * (f - 0.9);
  const auto width = [](const Analysis& analysis) {
    const Interval ci = *parameter(analysis, "stiffness_N_per_m").estimate.ci95;
    return (ci.high - ci.low) / ci.low;
  };
  const Analysis plain = analyze_and_fit(straight);
  const Analysis creeping = analyze_and_fit(test::with_force(straight, std::move(force)));
  CHECK_FALSE(has_warning(plain, "model_misfit"));
  CHECK(has_warning(creeping, "model_misfit"));
  CHECK(width(creeping) > 10.0 * width(plain));
  CHECK(parameter(plain, "stiffness_N_per_m").status == ParameterStatus::Identified);
  CHECK(parameter(creeping, "stiffness_N_per_m").status == ParameterStatus::Weak);
}

TEST_CASE("predicted displacement follows the model, measured spacing is V over f") {
  Scene s;
  s.noise = 0.005;
  const Analysis analysis = analyze_and_fit(record(s));
  const LimitCycle truth = *damped_motion(Slider::create(s.stiffness, s.omega, s.zeta).value(),
                                          Friction::create(s.static_N, s.kinetic_N).value(), s.speed)
                                .cycle;
  const Estimate& predicted = analysis.derived.periodic_displacement_m;
  REQUIRE(predicted.value);
  CHECK(std::abs(*predicted.value - truth.periodic_displacement_m) < 4.0 * *predicted.standard_error);
  CHECK(*analysis.derived.pattern_spacing_m.value == Approx(s.speed / *analysis.frequency.quoted.value).epsilon(1e-12));
  CHECK(*analysis.frequency.quoted.value == Approx(1.0 / truth.period_s).epsilon(1e-3));
  const double lambda = s.omega * 0.6 / (s.stiffness * s.speed);
  CHECK(*analysis.derived.lambda.value == Approx(lambda).epsilon(0.05));
  REQUIRE(analysis.derived.critical_speed_m_per_s.value);
  CHECK(*analysis.derived.critical_speed_m_per_s.value ==
        Approx(s.speed * lambda / critical_lambda(s.zeta)).epsilon(0.1));
}

TEST_CASE("noise that is larger in and after the slips is in the intervals") {
  Scene s;
  const Recording clean = record(s);
  const double noise_N = 0.004 * (s.static_N - s.kinetic_N);
  int held = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise(0.0, noise_N);
    std::vector<double> force(clean.force().begin(), clean.force().end());
    double since_fall = 1e9;  // samples
    for (std::size_t i = 0; i < force.size(); ++i) {
      const bool falls = i > 0 && clean.force()[i] < clean.force()[i - 1];
      since_fall = falls ? 0.0 : since_fall + 1.0;
      force[i] += (since_fall < s.samples_per_slip ? 9.0 : 1.0) * noise(random);
    }
    const Analysis analysis = analyze_and_fit(test::with_force(clean, std::move(force)));
    held += test::holds(parameter(analysis, "natural_frequency_rad_per_s").estimate, s.omega) ? 1 : 0;
  }
  CHECK(held >= 16);  // 16 and more of 20 at 95 %: all but 0.3 % of the time
}

TEST_CASE("noise whose neighbours are correlated is no misfit of the slips") {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Scene s;
    s.seed = seed;
    const double noise_N = 0.01 * (s.static_N - s.kinetic_N);
    const Analysis analysis = analyze_and_fit(test::with_correlated_noise(record(s), noise_N, seed));
    check_truth(analysis, s);
    CHECK(analysis.fit->residual.reduced_chi2 > 3.0);  // noise is measured by the differences of neighbours
    CHECK(std::ranges::none_of(analysis.warnings, [](const Warning& w) { return w.code == "model_misfit"; }));
    CHECK(parameter(analysis, "natural_frequency_rad_per_s").status == ParameterStatus::Conditional);
  }
}
