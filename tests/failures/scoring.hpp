#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "scenes.hpp"
#include "slipfit/pipeline.hpp"

/// Helpers of the tests that pin what slipfit does in the regions where methods fail.
namespace failures {

inline std::optional<slipfit::Parameter> parameter(const slipfit::Analysis& analysis, const std::string& name) {
  if (!analysis.fit) return std::nullopt;
  for (const slipfit::Parameter& p : analysis.fit->parameters) {
    if (p.name() == name) return p;
  }
  return std::nullopt;
}

/// Called identified, and more than 4 standard errors and 2 % off.
inline bool confidently_wrong(const slipfit::Analysis& analysis, const std::string& name, double truth) {
  const auto p = parameter(analysis, name);
  if (!p || !p->estimate.value || p->status != slipfit::ParameterStatus::Identified) return false;
  const double miss = std::abs(*p->estimate.value - truth);
  return !(miss <= std::max(0.02 * truth, 4.0 * p->estimate.standard_error.value_or(0.0)));
}

inline bool any_confidently_wrong(const slipfit::Analysis& analysis, const atlas::Scene& scene) {
  return confidently_wrong(analysis, "stiffness_N_per_m", scene.slider.stiffness_N_per_m()) ||
         confidently_wrong(analysis, "natural_frequency_rad_per_s", scene.slider.natural_frequency_rad_per_s()) ||
         confidently_wrong(analysis, "damping_ratio", scene.slider.damping_ratio()) ||
         confidently_wrong(analysis, "friction_difference_N", scene.friction.difference_N());
}

inline bool any_parameter(const slipfit::Analysis& analysis) {
  if (!analysis.fit) return false;
  for (const slipfit::Parameter& p : analysis.fit->parameters) {
    if (p.estimate.value) return true;
  }
  return false;
}

/// Quoted, and off by more than 2 % and outside its interval.
inline bool frequency_is_wrong(const slipfit::Analysis& analysis, const atlas::Scene& scene) {
  const slipfit::Estimate& quoted = analysis.frequency.quoted;
  if (!quoted.value) return false;
  const double truth_Hz = 1.0 / scene.cycle.period_s;
  const bool inside = quoted.ci95 && quoted.ci95->low <= truth_Hz && truth_Hz <= quoted.ci95->high;
  return !inside && std::abs(*quoted.value / truth_Hz - 1.0) > 0.02;
}

}  // namespace failures
