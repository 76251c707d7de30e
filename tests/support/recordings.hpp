#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string_view>
#include <utility>
#include <vector>

#include "slipfit/core/recording.hpp"

namespace test {

/// A recording at this driving speed; its zero is not stated.
inline slipfit::Recording recording_of(std::vector<double> time_s, std::vector<double> force, double speed_m_per_s) {
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = speed_m_per_s;
  return slipfit::Recording::create(std::move(time_s), std::move(force), conditions).value();
}

/// Every so many samples of a recording, from the first on.
inline slipfit::Recording thinned(const slipfit::Recording& recording, std::size_t every) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < recording.size(); i += every) kept.push_back(i);
  return recording.selected(kept);
}

/// The same clock and conditions with other forces.
inline slipfit::Recording with_force(const slipfit::Recording& recording, std::vector<double> force) {
  return slipfit::Recording::create({recording.time_s().begin(), recording.time_s().end()}, std::move(force),
                                    recording.conditions())
      .value();
}

/// The same with noise of this rms, whose neighbours correlate by 0.9.
inline slipfit::Recording with_correlated_noise(const slipfit::Recording& recording, double rms, std::uint64_t seed) {
  constexpr double kCorrelation = 0.9;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, rms);
  std::vector<double> force(recording.force().begin(), recording.force().end());
  double noise = 0.0;
  for (double& value : force) {
    noise = kCorrelation * noise + std::sqrt(1.0 - kCorrelation * kCorrelation) * normal(random);
    value += noise;
  }
  return with_force(recording, std::move(force));
}

/// The same samples under other conditions, with the normal force of each sample where it is given.
inline slipfit::Recording with_conditions(const slipfit::Recording& recording, const slipfit::Conditions& conditions,
                                          std::vector<double> load_N = {}) {
  return slipfit::Recording::create({recording.time_s().begin(), recording.time_s().end()},
                                    {recording.force().begin(), recording.force().end()}, conditions, {},
                                    std::move(load_N))
      .value();
}

inline bool warns(const slipfit::Warnings& warnings, std::string_view code) {
  for (const slipfit::Warning& warning : warnings) {
    if (warning.code == code) return true;
  }
  return false;
}

}  // namespace test
