#include "fit/selection/qualify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string>
#include <utility>

#include "core/thresholds.hpp"
#include "core/unknown.hpp"
#include "signal/mains.hpp"

namespace slipfit::fit {

FitResult without_parameters(FitResult fit) {
  for (Parameter& parameter : fit.parameters) {
    if (parameter.status == ParameterStatus::Fixed) continue;
    parameter.status = ParameterStatus::Unidentified;
    parameter.estimate = unknown("the motion is not stick-slip of this model");
  }
  fit.correlation.reset();
  fit.estimate.reset();
  fit.level_trend = {};
  constexpr std::array kOfParameters{"level_trend", "samples_averaged", "part_of_cycles_fitted"};
  std::erase_if(fit.warnings, [&](const Warning& warning) { return std::ranges::count(kOfParameters, warning.code); });
  for (Warning& warning : fit.warnings) {  // how far off it is says nothing where it is another motion
    if (warning.code != "model_misfit") continue;
    warning.message = "the model does not describe the slips: no parameter is determined";
  }
  return fit;
}

FitResult qualified_by_mains(FitResult fit, double frequency_Hz, double duration_s) {
  const bool hum_found = fit.diagnostics.hum_share > 0.0;
  const std::optional<double> mains_Hz = signal::mains_in_step(frequency_Hz, hum_found ? 2 : 1, duration_s);
  if (!mains_Hz) return fit;
  const std::string reason = fmt::format("in step with {:.0f} Hz mains: hum hides in the cycles", *mains_Hz);
  fit.warnings.push_back(
      {"mains_in_step",
       fmt::format("the cycles ({:.4g} Hz) keep {}{}; another speed or a longer recording sets them apart",
                   frequency_Hz, reason, hum_found ? "" : ", and is taken to be absent")});
  for (Parameter& parameter : fit.parameters) {
    if (!hum_found || parameter.status != ParameterStatus::Identified) continue;
    parameter.status = ParameterStatus::Weak;
    parameter.estimate.note = reason;
  }
  return fit;
}

namespace {

bool depends_on_inertia(ParameterId id) {
  return id == ParameterId::NaturalFrequency || id == ParameterId::Mass || id == ParameterId::DampingRatio ||
         id == ParameterId::DampingCoefficient;
}

/// Nothing that rests on the inertia of the slips.
FitResult without_inertia(FitResult fit, const std::string& reason, double force_drop) {
  const Interval bounds{0.5 * force_drop, force_drop};
  for (Parameter& parameter : fit.parameters) {
    if (parameter.status == ParameterStatus::Fixed) continue;
    if (depends_on_inertia(parameter.id)) {
      parameter.status = ParameterStatus::Unidentified;
      parameter.estimate = unknown(reason);
    } else if (parameter.id == ParameterId::FrictionDifference) {
      parameter.status = ParameterStatus::Bounded;
      parameter.estimate = {0.75 * force_drop, std::nullopt, bounds,
                            "between half and all of the force drop: " + reason};
    }
  }
  fit.correlation.reset();
  fit.estimate.reset();
  return fit;
}

FitResult with_doubtful_inertia(FitResult fit, const std::string& reason) {
  for (Parameter& parameter : fit.parameters) {
    if (!depends_on_inertia(parameter.id)) continue;
    if (parameter.status == ParameterStatus::Unidentified || parameter.status == ParameterStatus::Fixed) continue;
    parameter.status = ParameterStatus::Weak;
    parameter.estimate.note = reason;
  }
  return fit;
}

}  // namespace

FitResult qualified_by_ring_down(FitResult fit, double ring_down_frequency_Hz, double force_drop) {
  const Estimate natural = fit.natural_frequency();
  if (!natural.value) return fit;
  const double slip_Hz = *natural.value / (2.0 * std::numbers::pi);
  if (slip_Hz > thresholds::kInertialSlip * ring_down_frequency_Hz) return fit;
  const bool misfits = std::any_of(fit.warnings.begin(), fit.warnings.end(),
                                   [](const Warning& warning) { return warning.code == "model_misfit"; });
  const std::string slower =
      fmt::format("the slips ({:.3g} Hz) are much slower than the free ring-down of the rig ({:.3g} Hz)", slip_Hz,
                  ring_down_frequency_Hz);
  if (misfits) {
    const std::string reason = slower + ", so inertia does not determine them";
    fit.warnings.push_back({"slips_not_inertial", reason});
    return without_inertia(std::move(fit), reason, force_drop);
  }
  const std::string reason = slower + ": assumes that another body rings";
  fit.warnings.push_back({"slips_not_inertial", reason});
  return with_doubtful_inertia(std::move(fit), reason);
}

}  // namespace slipfit::fit
