#include "fit/report/open_damping.hpp"

#include <algorithm>
#include <cmath>

#include "core/fit_thresholds.hpp"

namespace slipfit::fit {

namespace {

/// Returns the shortest average that the recordings state; 0 if one of them states none.
double shortest_average_s(std::span<const SweepRecording> recordings) {
  double shortest_s = HUGE_VAL;
  for (const SweepRecording& sweep : recordings) {
    if (sweep.role == SweepRole::LeftOut) continue;
    shortest_s = std::min(shortest_s, sweep.recording.conditions().sensor_average_s.value_or(0.0));
  }
  return std::isfinite(shortest_s) ? shortest_s : 0.0;
}

/// Returns whether the sensor averages over most of the slip: its shape determines zeta only where the model explains
/// the rest.
bool is_hidden(const FitResult& result, std::span<const SweepRecording> recordings) {
  const bool agree = std::none_of(result.warnings.begin(), result.warnings.end(),
                                  [](const Warning& warning) { return warning.code == "recordings_disagree"; });
  const bool explains = agree && !(result.residual.reduced_chi2 > thresholds::kSweepMisfit);
  if (explains || result.mass_gives_frequency) return false;
  const std::optional<FittedAverage> found = found_average(result);
  const double average_s = found ? found->seconds : shortest_average_s(recordings);
  return average_s * result.natural_frequency().value.value_or(0.0) > thresholds::kHidingAverage;
}

}  // namespace

std::optional<FittedAverage> found_average(const FitResult& result) {
  const Parameter* const average = result.find(ParameterId::SensorAverage);
  if (average == nullptr || average->status == ParameterStatus::Fixed || !average->estimate.value) return std::nullopt;
  return FittedAverage{*average->estimate.value, average->estimate.standard_error.value_or(0.0)};
}

bool is_damping_open(const FitResult& result, std::span<const SweepRecording> recordings) {
  const Parameter* const zeta = result.find(ParameterId::DampingRatio);
  if (zeta == nullptr || zeta->status != ParameterStatus::Weak || !zeta->estimate.ci95) return false;
  return is_hidden(result, recordings) || (zeta->estimate.ci95->low <= 0.0 && zeta->estimate.ci95->high >= 1.0);
}

void report_open_damping(FitResult& result) {
  for (Parameter& parameter : result.parameters) {
    if (parameter.id != ParameterId::DampingRatio) continue;
    const double error = 1.0 / std::sqrt(12.0);  // anything between 0 and 1 is as likely
    parameter.estimate = {0.0, error, Interval{0.0, 1.0}, "it can lie anywhere between 0 and 1: the fit takes 0"};
    parameter.status = ParameterStatus::Weak;
  }
  if (result.estimate) result.estimate->damping_identified = false;
  result.conditional_on.emplace_back("a damping ratio of 0, of which the recordings say nothing");
}

}  // namespace slipfit::fit
