#include "analysis/ranges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "slipfit/core/range.hpp"

namespace slipfit {
namespace {

/// A force level is not negative where the sensor's zero is known: else it stands on an unknown one.
Range range_of(const Parameter& parameter, const Conditions& conditions) {
  const ParameterInfo& row = info(parameter.id);
  const bool has_zero = conditions.zero_force_N && parameter.estimate.value.value_or(-1.0) >= 0.0;
  return row.hangs_on_zero && has_zero ? kNotNegative : row.range;
}

/// One without a value or an interval is unidentified, and its value is withdrawn.
Parameter within(Parameter parameter, const Range& range) {
  parameter.estimate = within(std::move(parameter.estimate), range);
  Estimate& estimate = parameter.estimate;
  if (parameter.status == ParameterStatus::Unidentified || (estimate.value && estimate.ci95)) return parameter;
  parameter.status = ParameterStatus::Unidentified;
  if (estimate.note.empty()) estimate.note = "the data give no value with an interval";
  estimate.value = estimate.standard_error = std::nullopt;
  estimate.ci95 = std::nullopt;
  return parameter;
}

bool all_finite(const ModelEstimate& model) {
  double sum = 0.0;
  for (const double value : values_of(model)) sum += std::abs(value);
  for (const auto& row : model.covariance) {
    for (const double cell : row) sum += std::abs(cell);
  }
  return std::isfinite(sum);
}

bool all_finite(const Correlation& correlation) {
  for (const std::vector<double>& row : correlation.matrix) {
    for (const double cell : row) {
      if (!std::isfinite(cell)) return false;
    }
  }
  return true;
}

SweepPoint in_range(SweepPoint point) {
  point.rms = within(point.rms, kNotNegative);
  point.kinetic_friction_N = within(std::move(point.kinetic_friction_N), kAnyNumber);
  point.mean_steady_force_N = within(std::move(point.mean_steady_force_N), kAnyNumber);
  point.spacing_m = within(std::move(point.spacing_m), kNotNegative);
  point.spacing_left_out_m = within(std::move(point.spacing_left_out_m), kNotNegative);
  return point;
}

SpectralFrequency in_range(SpectralFrequency spectral) {
  spectral.value_Hz = within(spectral.value_Hz, kNotNegative);
  spectral.standard_error_Hz = spectral.value_Hz ? within(spectral.standard_error_Hz, kNotNegative) : std::nullopt;
  spectral.false_alarm_probability = within(spectral.false_alarm_probability, kShare).value_or(1.0);
  std::erase_if(spectral.harmonics_Hz, [](double frequency_Hz) { return !std::isfinite(frequency_Hz); });
  std::erase_if(spectral.suspicious_lines,
                [](const SuspiciousLine& line) { return !std::isfinite(line.frequency_Hz); });
  return spectral;
}

}  // namespace

FitResult in_range(FitResult fit, const Conditions& conditions) {
  for (Parameter& parameter : fit.parameters) {
    const Range range = range_of(parameter, conditions);
    parameter = within(std::move(parameter), range);
  }
  if ((fit.estimate && !all_finite(*fit.estimate)) || (fit.correlation && !all_finite(*fit.correlation))) {
    fit.estimate = std::nullopt;  // nothing can be derived from it
    fit.correlation = std::nullopt;
  }
  fit.residual.reduced_chi2 = within(fit.residual.reduced_chi2, kNotNegative);
  fit.residual.whiteness_p = within(fit.residual.whiteness_p, kShare);
  for (Candidate& candidate : fit.candidates) {
    candidate.rms = within(candidate.rms, kNotNegative);
    candidate.aicc = within(candidate.aicc, kAnyNumber);
  }
  return fit;
}

FrequencyReport in_range(FrequencyReport frequency) {
  frequency.quoted = within(std::move(frequency.quoted), kNotNegative);
  frequency.counted = within(std::move(frequency.counted), kNotNegative);
  frequency.spectral = in_range(std::move(frequency.spectral));
  if (!frequency.quoted.value) frequency.method = "none";
  return frequency;
}

CycleStatistics in_range(CycleStatistics cycles) {
  for (auto* const time_s : {&cycles.period_s, &cycles.period_sd_s, &cycles.slip_time_s, &cycles.stick_time_s}) {
    *time_s = within(*time_s, kNotNegative);
  }
  cycles.sticking_degree = within(cycles.sticking_degree, kShare);
  for (auto* const force : {&cycles.peak_force, &cycles.trough_force}) *force = within(*force, kAnyNumber);
  for (auto* const spread :
       {&cycles.peak_force_sd, &cycles.force_drop, &cycles.force_drop_sd, &cycles.drop_cv, &cycles.period_cv}) {
    *spread = within(*spread, kNotNegative);
  }
  cycles.stick_stiffness = within(std::move(cycles.stick_stiffness), kNotNegative);
  return cycles;
}

Derived in_range(Derived derived) {
  for (Estimate* const quantity :
       {&derived.lambda, &derived.lambda_critical, &derived.critical_speed_m_per_s, &derived.periodic_displacement_m,
        &derived.pattern_spacing_m, &derived.micro_vibration_spacing_m, &derived.impulse_rate_per_m}) {
    *quantity = within(std::move(*quantity), kNotNegative);
  }
  derived.gamma = within(std::move(derived.gamma), {1.0, std::numeric_limits<double>::infinity()});
  derived.pattern_spacing_sd_m = within(derived.pattern_spacing_sd_m, kNotNegative);
  for (auto* const quantity : {&derived.surface_spacing_m, &derived.surface_ratio}) {
    if (*quantity) *quantity = within(**quantity, kNotNegative);
  }
  if (derived.surface_En) derived.surface_En = within(*std::move(derived.surface_En), kAnyNumber);
  if (derived.measured_spacing_En) {
    derived.measured_spacing_En = within(*std::move(derived.measured_spacing_En), kAnyNumber);
  }
  return derived;
}

Transients in_range(Transients transients) {
  Transients t;
  t.loading_stiffness_N_per_m = within(std::move(transients.loading_stiffness_N_per_m), kNotNegative);
  t.breakaway_force = within(std::move(transients.breakaway_force), kAnyNumber);
  t.ring_down_frequency_Hz = within(std::move(transients.ring_down_frequency_Hz), kNotNegative);
  t.ring_down_damping_ratio = within(std::move(transients.ring_down_damping_ratio), kShare);
  return t;
}

std::optional<Coefficients> in_range(std::optional<Coefficients> coefficients) {
  if (!coefficients) return coefficients;
  std::vector<Estimate*> estimates{&coefficients->static_first_peak, &coefficients->static_mean_peak,
                                   &coefficients->kinetic_mean, &coefficients->kinetic_first_third,
                                   &coefficients->kinetic_last_third};
  for (StandardCoefficients& standard : coefficients->standards) {
    estimates.insert(estimates.end(), {&standard.static_coefficient, &standard.kinetic_coefficient});
  }
  for (Estimate* estimate : estimates) *estimate = within(std::move(*estimate), kNotNegative);
  return coefficients;
}

std::optional<SweepFit> in_range(std::optional<SweepFit> sweep) {
  if (!sweep) return sweep;
  sweep->result = in_range(std::move(sweep->result), {});
  for (SweepPoint& point : sweep->points) point = in_range(std::move(point));
  return sweep;
}

}  // namespace slipfit
