#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "slipfit/model/simulation.hpp"
#include "slipfit/pipeline.hpp"
#include "support/recordings.hpp"

namespace slipfit {

/// A simulated recording and its fit, with numbers of a soft contact in the laboratory.
struct Scene {
  double stiffness = 500.0, omega = 120.0, zeta = 0.06, static_N = 2.0, kinetic_N = 1.4, speed = 0.01;
  double cycles = 30.0, samples_per_slip = 30.0;
  double jitter = 0.0, noise = 0.0, drift_over_drop = 0.0, hum = 0.0;
  ForceView view = ForceView::Spring;
  std::uint64_t seed = 1;
  Conditions conditions = {};  ///< speed, view and zero are filled in
};

inline Recording record(const Scene& s) {
  const Slider slider = Slider::create(s.stiffness, s.omega, s.zeta).value();
  const Friction friction = Friction::create(s.static_N, s.kinetic_N).value();
  const LimitCycle cycle = *damped_motion(slider, friction, s.speed).cycle;
  const double difference = s.static_N - s.kinetic_N;
  SimulationOptions options{.duration_s = s.cycles * cycle.period_s,
                            .sample_rate_Hz = s.samples_per_slip / cycle.slip_s,
                            .force_view = s.view,
                            .static_friction_sd_N = s.jitter * difference,
                            .noise_rms_N = s.noise * difference};
  options.drift_N_per_s = s.drift_over_drop * difference / options.duration_s;
  options.hum_N = s.hum * difference;
  options.seed = s.seed;
  SimulatedTrace trace = simulate(slider, friction, s.speed, options);
  Conditions conditions = s.conditions;
  conditions.speed_m_per_s = s.speed;
  conditions.force_view = s.view;
  conditions.zero_force_N = 0.0;
  return Recording::create(std::move(trace.time_s), std::move(trace.force_N), conditions).value();
}

/// Every sample averaged over so many, noise added after it.
inline Recording moving_average(const Recording& exact, std::size_t samples, double noise_N, std::uint64_t seed) {
  std::vector<double> time_s, force;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, noise_N);
  for (std::size_t begin = 0; begin + samples <= exact.size(); ++begin) {
    double sum = 0.0;
    for (std::size_t i = begin; i < begin + samples; ++i) sum += exact.force()[i];
    time_s.push_back(0.5 * (exact.time_s()[begin] + exact.time_s()[begin + samples - 1]));
    force.push_back(sum / static_cast<double>(samples) + noise(random));
  }
  return Recording::create(std::move(time_s), std::move(force), exact.conditions()).value();
}

inline const Parameter& parameter(const Analysis& analysis, std::string_view name) {
  for (const Parameter& p : analysis.fit->parameters) {
    if (p.name() == name) return p;
  }
  FAIL("no parameter " << name);
  return analysis.fit->parameters.front();
}

/// 4 standard errors: 1 in 16 000 is further off by chance.
inline void check_truth(const Analysis& analysis, const std::string& name, double truth) {
  INFO(name);
  const Estimate& estimate = parameter(analysis, name).estimate;
  REQUIRE(estimate.value);
  REQUIRE(estimate.standard_error);
  CHECK(std::abs(*estimate.value - truth) < 4.0 * *estimate.standard_error);
}

/// k, w_n, F_s - F_k and zeta.
inline void check_truth(const Analysis& analysis, const Scene& s) {
  check_truth(analysis, "stiffness_N_per_m", s.stiffness);
  check_truth(analysis, "natural_frequency_rad_per_s", s.omega);
  check_truth(analysis, "friction_difference_N", s.static_N - s.kinetic_N);
  check_truth(analysis, "damping_ratio", s.zeta);
}

inline bool has_warning(const Analysis& analysis, const std::string& code) {
  return test::warns(analysis.warnings, code);
}

}  // namespace slipfit
