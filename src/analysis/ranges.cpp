#include "analysis/ranges.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "slipfit/core/range.hpp"

namespace slipfit {
namespace {

/// A force level is not negative where the sensor's zero is known: otherwise it is relative to an unknown one.
Range range_of(const Parameter& parameter, const Conditions& conditions) {
  const ParameterInfo& row = info(parameter.id);
  const bool has_zero = conditions.zero_force_N && parameter.estimate.value.value_or(-1.0) >= 0.0;
  return row.depends_on_sensor_zero && has_zero ? kNotNegative : row.range;
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

std::optional<Estimate> within(std::optional<Estimate> estimate, const Range& range) {
  return estimate ? std::optional(within(*std::move(estimate), range)) : std::nullopt;
}

template <class... Values>
void keep_in(const Range& range, Values&... values) {
  ((values = within(std::move(values), range)), ...);
}

bool all_finite(const ModelEstimate& model) {
  double sum = 0.0;
  for (const ParameterId id : kModelParameters) {
    if (const double* const value = model.find(id)) sum += std::abs(*value);
  }
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
  keep_in(kNotNegative, point.rms, point.spacing_m, point.spacing_left_out_m);
  keep_in(kAnyNumber, point.kinetic_friction_N, point.mean_steady_force_N);
  return point;
}

SpectralFrequency in_range(SpectralFrequency spectral) {
  keep_in(kNotNegative, spectral.value_Hz);
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
  keep_in(kNotNegative, fit.residual.reduced_chi2);
  keep_in(kShare, fit.residual.whiteness_p);
  for (Candidate& candidate : fit.candidates) {
    keep_in(kNotNegative, candidate.rms);
    keep_in(kAnyNumber, candidate.aicc);
  }
  return fit;
}

FrequencyReport in_range(FrequencyReport frequency) {
  keep_in(kNotNegative, frequency.quoted, frequency.counted);
  frequency.spectral = in_range(std::move(frequency.spectral));
  if (!frequency.quoted.value) frequency.method = FrequencyMethod::None;
  return frequency;
}

CycleStatistics in_range(CycleStatistics cycles) {
  keep_in(kNotNegative, cycles.period_s, cycles.period_sd_s, cycles.period_cv, cycles.slip_time_s, cycles.stick_time_s,
          cycles.peak_force_sd, cycles.force_drop, cycles.force_drop_sd, cycles.drop_cv, cycles.stick_stiffness);
  keep_in(kShare, cycles.sticking_degree);
  keep_in(kAnyNumber, cycles.peak_force, cycles.trough_force);
  return cycles;
}

Derived in_range(Derived derived) {
  keep_in(kNotNegative, derived.lambda, derived.lambda_critical, derived.critical_speed_m_per_s,
          derived.periodic_displacement_m, derived.pattern_spacing_m, derived.pattern_spacing_sd_m,
          derived.micro_vibration_spacing_m, derived.impulse_rate_per_m, derived.surface_spacing_m,
          derived.surface_ratio);
  keep_in({1.0, std::numeric_limits<double>::infinity()}, derived.gamma);
  keep_in(kAnyNumber, derived.surface_En, derived.measured_spacing_En);
  return derived;
}

Transients in_range(Transients transients) {
  keep_in(kNotNegative, transients.loading_stiffness_N_per_m, transients.ring_down_frequency_Hz);
  keep_in(kAnyNumber, transients.breakaway_force);
  keep_in(kShare, transients.ring_down_damping_ratio);
  return transients;
}

std::optional<Coefficients> in_range(std::optional<Coefficients> coefficients) {
  if (!coefficients) return coefficients;
  keep_in(kNotNegative, coefficients->static_first_peak, coefficients->static_mean_peak, coefficients->kinetic_mean,
          coefficients->kinetic_first_third, coefficients->kinetic_last_third);
  for (StandardCoefficients& standard : coefficients->standards) {
    keep_in(kNotNegative, standard.static_coefficient, standard.kinetic_coefficient);
  }
  return coefficients;
}

std::optional<SweepFit> in_range(std::optional<SweepFit> sweep) {
  if (!sweep) return sweep;
  sweep->result = in_range(std::move(sweep->result), {});
  for (SweepPoint& point : sweep->points) point = in_range(std::move(point));
  return sweep;
}

}  // namespace slipfit
