#include "fit/selection/qualify.hpp"

#include <fmt/format.h>

#include <string>

#include "signal/mains.hpp"

namespace slipfit::fit {

FitResult without_parameters(FitResult fit) {
  for (Parameter& parameter : fit.parameters) {
    if (parameter.status == ParameterStatus::Fixed) continue;
    parameter.status = ParameterStatus::Unidentified;
    parameter.estimate = {std::nullopt, std::nullopt, std::nullopt, "the motion is not stick-slip of this model"};
  }
  fit.correlation.reset();
  fit.estimate.reset();
  return fit;
}

FitResult qualified_by_mains(FitResult fit, double frequency_Hz, double duration_s) {
  const bool hum_found = fit.evidence.hum_share > 0.0;
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

}  // namespace slipfit::fit
