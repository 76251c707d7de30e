#pragma once

#include <utility>

#include "slipfit/core/recording.hpp"
#include "slipfit/model/motion.hpp"
#include "slipfit/model/simulation.hpp"

/// What studies of speed fit: static friction that scatters by 5 % and noise of 1 % of F_s - F_k, at 10 mm/s.
inline slipfit::Recording usual_recording(double cycles, double samples_per_cycle) {
  constexpr double kSpeed_m_per_s = 0.01;
  const auto slider = slipfit::Slider::create(5000.0, 900.0, 0.05).value();
  const auto friction = slipfit::Friction::create(4.0, 3.0).value();
  const double period_s = slipfit::damped_motion(slider, friction, kSpeed_m_per_s).cycle->period_s;
  slipfit::SimulationOptions options;
  options.duration_s = cycles * period_s;
  options.sample_rate_Hz = samples_per_cycle / period_s;
  options.static_friction_sd_N = 0.05;
  options.noise_rms_N = 0.01;
  slipfit::SimulatedTrace trace = slipfit::simulate(slider, friction, kSpeed_m_per_s, options);
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = kSpeed_m_per_s;
  return slipfit::Recording::create(std::move(trace.time_s), std::move(trace.force_N), conditions).value();
}
