#include "measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "fit/inference/student.hpp"
#include "fitted_frequency.hpp"
#include "recording_checks.hpp"
#include "signal/robust.hpp"

namespace slipfit {
namespace {

constexpr double kGapSteps = 3.5;
/// Above this scatter of the intervals the harmonic fit is no better than the count (docs/accuracy.md).
constexpr double kRegular = 0.01;
/// Scatter of the cycles sets spectrum and count less far apart than this; another repetition (hum, noise) farther.
constexpr double kContradiction = 0.3;

/// Cycles shorter than this many lags of the sensor: 8 of them pass before a ramp is fitted, and the slip takes some.
constexpr double kForgotten = 14.0;

struct MeanAndSpread {
  double mean = 0.0;
  double sd = 0.0;
  double count = 0.0;
};

MeanAndSpread describe(const std::vector<double>& values) {
  MeanAndSpread result;
  result.count = static_cast<double>(values.size());
  if (values.empty()) return result;
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / result.count;
  for (const double value : values) result.sd += (value - result.mean) * (value - result.mean);
  result.sd = values.size() > 1 ? std::sqrt(result.sd / (result.count - 1.0)) : 0.0;
  return result;
}

/// From slip to slip, without the first slip and without intervals that hold a gap.
std::vector<double> intervals_s(const Recording& recording, const Segmentation& segmentation) {
  const auto time_s = recording.time_s();
  const double gap_s = kGapSteps * recording.sample_interval_s();
  const bool may_have_gaps = !recording.clock_is_even();
  std::vector<double> intervals;
  for (std::size_t i = 2; i < segmentation.slips.size(); ++i) {
    const DetectedSlip& first = segmentation.slips[i - 1];
    const DetectedSlip& second = segmentation.slips[i];
    bool whole = true;
    for (std::size_t j = first.peak + 1; may_have_gaps && j <= second.trough; ++j) {
      whole = whole && time_s[j] - time_s[j - 1] <= gap_s;
    }
    if (whole) intervals.push_back(second.middle_s - first.middle_s);
  }
  return intervals;
}

/// Of the two frequencies; empty where one of them is.
std::optional<double> relative_difference(const SpectralFrequency& spectral, const Estimate& counted) {
  if (!spectral.value_Hz || !counted.value) return std::nullopt;
  return std::abs(*spectral.value_Hz / *counted.value - 1.0);
}

/// Harmonic least squares uses every sample, onsets what the slips show of them: on regular cycles it is two to five
/// times as exact (docs/accuracy.md), unless hum or drift, which the fit allows for and the spectrum does not, are in
/// its error. Where the two contradict each other the fit is believed: it knows a slip from other repetitions.
bool is_sharper(const SpectralFrequency& spectral, const Estimate& fitted) {
  if (!spectral.value_Hz || !spectral.regular_standard_error_Hz) return false;
  constexpr double kFarApart = 4.0;  // standard errors
  const double difference_Hz = std::abs(*spectral.value_Hz - *fitted.value);
  return *spectral.regular_standard_error_Hz < *fitted.standard_error &&
         difference_Hz < kFarApart * *fitted.standard_error;
}

/// A line of the mains swings far enough to be counted as slips.
bool hum_makes_falls(const Signals& signals) {
  const auto& lines = signals.spectral.suspicious_lines;
  return std::any_of(lines.begin(), lines.end(),
                     [&](const SuspiciousLine& line) { return line.swing > signals.segmentation.hysteresis; });
}

/// With an interval that holds what the spectrum shows, where counting and spectrum do not agree: hum or noise may have
/// made slips, scatter of the cycles may have blurred the lines.
Estimate reaching(Estimate counted, const SpectralFrequency& spectral) {
  const double spectral_Hz = *spectral.value_Hz;
  counted.note = fmt::format("the spectrum shows {:.4g} Hz, to which the interval reaches", spectral_Hz);
  if (!counted.ci95) return counted;
  const double half_Hz = 2.0 * spectral.standard_error_Hz.value_or(0.0);
  counted.ci95->low = std::min(counted.ci95->low, spectral_Hz - half_Hz);
  counted.ci95->high = std::max(counted.ci95->high, spectral_Hz + half_Hz);
  const double longer = std::max(*counted.value - counted.ci95->low, counted.ci95->high - *counted.value);
  counted.standard_error = std::max(*counted.standard_error, longer / 1.96);
  return counted;
}

}  // namespace

Estimate count_frequency(const Recording& recording, const Segmentation& segmentation) {
  const MeanAndSpread interval = describe(intervals_s(recording, segmentation));
  if (interval.count < 1.0) return {std::nullopt, std::nullopt, std::nullopt, "fewer than 3 slips"};
  const double value = 1.0 / interval.mean;
  if (interval.count < 2.0) return {value, std::nullopt, std::nullopt, "one interval tells no error"};
  return fit::symmetric(value, value * interval.sd / interval.mean / std::sqrt(interval.count), interval.count - 1.0);
}

FrequencyReport report_frequency(const Recording& recording, const Signals& signals, Verdict verdict,
                                 const FitResult* fit) {
  const Segmentation& segmentation = signals.segmentation;
  const SpectralFrequency& spectral = signals.spectral;
  FrequencyReport report;
  report.spectral = spectral;
  report.counted = count_frequency(recording, segmentation);
  report.method = "none";
  if (fit != nullptr && verdict == Verdict::StickSlip) {
    if (const auto fitted = fitted_frequency(*fit, recording)) {
      report.method = "fitted_cycles";
      report.quoted = *fitted;
      if (is_sharper(spectral, *fitted)) {
        report.method = "harmonic_least_squares";
        const double freedom = std::max(1.0, static_cast<double>(segmentation.slips.size()) - 3.0);
        report.quoted = fit::symmetric(*spectral.value_Hz, *spectral.regular_standard_error_Hz, freedom);
      }
      return report;
    }
  }
  const MeanAndSpread interval = describe(intervals_s(recording, segmentation));
  const std::optional<double> difference = relative_difference(spectral, report.counted);
  const bool agree = difference && *difference < 0.05;
  // Without sticks, what was counted may be the noise or the hum on a slower repetition.
  const bool cycles_seen =
      verdict == Verdict::StickSlip || (verdict == Verdict::OscillatorySlip && (agree || !spectral.value_Hz));
  const bool regular = interval.count >= 2.0 && interval.sd < kRegular * interval.mean;
  if (spectral.value_Hz && spectral.standard_error_Hz && ((agree && regular) || !cycles_seen)) {
    report.method = "harmonic_least_squares";
    report.quoted =
        fit::symmetric(*spectral.value_Hz, *spectral.standard_error_Hz, std::max(1.0, interval.count - 1.0));
    if (agree || verdict != Verdict::Undetermined) return report;
  }
  const bool contradict = difference && *difference > kContradiction;
  const bool may_count_hum = !spectral.value_Hz && hum_makes_falls(signals);
  if (report.counted.value && (cycles_seen || agree) && !contradict && !may_count_hum) {
    report.method = "slip_counting";
    report.quoted = agree || !spectral.value_Hz ? report.counted : reaching(report.counted, spectral);
  }
  if (!report.quoted.value) {
    report.quoted.note = contradict ? fmt::format("counting slips gives {:.4g} Hz, the spectrum {:.4g} Hz",
                                                  *report.counted.value, *spectral.value_Hz)
                         : may_count_hum && cycles_seen
                             ? "hum of the mains may have made slips, and the spectrum shows no other repetition"
                             : "no repetition stands out of the noise";
  }
  return report;
}

CycleStatistics summarise_cycles(const Recording& recording, const Segmentation& segmentation, const FitResult* fit) {
  CycleStatistics result;
  result.count = segmentation.slips.size();
  result.minor = segmentation.minor;
  if (segmentation.slips.empty()) return result;
  std::vector<double> peaks;
  std::vector<double> troughs;
  std::vector<double> drops;
  const std::size_t first = segmentation.slips.size() > 3 ? 1 : 0;  // the first slip starts from rest
  for (std::size_t i = first; i < segmentation.slips.size(); ++i) {
    peaks.push_back(segmentation.slips[i].peak_force);
    troughs.push_back(segmentation.slips[i].trough_force);
    drops.push_back(segmentation.slips[i].drop());
  }
  const MeanAndSpread peak = describe(peaks);
  const MeanAndSpread drop = describe(drops);
  result.peak_force = peak.mean;
  result.trough_force = describe(troughs).mean;
  result.force_drop = drop.mean;
  if (peak.count > 1.0) {
    result.peak_force_sd = peak.sd;
    result.force_drop_sd = drop.sd;
  }
  const MeanAndSpread interval = describe(intervals_s(recording, segmentation));
  if (interval.count >= 1.0) result.period_s = interval.mean;
  if (interval.count >= 2.0) result.period_sd_s = interval.sd;
  if (fit == nullptr) return result;
  std::vector<double> slips;
  for (const Cycle& cycle : fit->cycles) {
    if (cycle.used) slips.push_back(*cycle.end_s - *cycle.onset_s);
  }
  result.used = slips.size();
  if (fit->tier == Tier::Sawtooth || !result.period_s) return result;
  result.slip_time_s = describe(slips).mean;
  result.stick_time_s = std::max(0.0, *result.period_s - *result.slip_time_s);
  result.sticking_degree = *result.stick_time_s / *result.period_s;
  return result;
}

void add_measured_spacing(const Recording& recording, const FrequencyReport& frequency, const CycleStatistics& cycles,
                          Derived& derived) {
  if (!frequency.quoted.value) {
    derived.pattern_spacing_m.note = derived.impulse_rate_per_m.note = "no frequency, no spacing";
    return;
  }
  const double speed = recording.conditions().speed_m_per_s;
  const double spacing = speed / *frequency.quoted.value;
  derived.pattern_spacing_m = {spacing, std::nullopt, std::nullopt, "V / f at the measured speed"};
  derived.impulse_rate_per_m = {1.0 / spacing, std::nullopt, std::nullopt, {}};
  if (cycles.period_sd_s) derived.pattern_spacing_sd_m = speed * *cycles.period_sd_s;
  if (!frequency.quoted.standard_error) return;
  const double of_frequency = *frequency.quoted.standard_error / *frequency.quoted.value;
  const double of_speed = recording.conditions().speed_standard_error_m_per_s.value_or(0.0) / speed;
  const double relative = std::hypot(of_frequency, of_speed);
  const double freedom = std::max(1.0, static_cast<double>(cycles.count) - 3.0);
  derived.pattern_spacing_m = fit::symmetric(spacing, spacing * relative, freedom);
  derived.pattern_spacing_m.note = "V / f at the measured speed";
  derived.impulse_rate_per_m = fit::symmetric(1.0 / spacing, relative / spacing, freedom);
}

Warnings collect_warnings(const Recording& recording, const Analysis& analysis) {
  Warnings warnings = recording.provenance().warnings;
  const auto warn = [&](const char* code, std::string message) { warnings.push_back({code, std::move(message)}); };
  const Quality& quality = analysis.quality;
  if (quality.gaps > 0) {
    warn("gaps", fmt::format("{} gap(s) in the clock, the longest {:.3g} s", quality.gaps, quality.longest_gap_s));
  }
  if (quality.clock_jitter > 0.05) {
    warn("uneven_clock", fmt::format("the time step varies by {:.0f} %", 100.0 * quality.clock_jitter));
  }
  if (quality.clipped_samples > 0) {
    warn("clipped", fmt::format("{} samples at a level where the sensor saturates: left out", quality.clipped_samples));
  }
  if (quality.impulses > 0) {
    warn("impulses", fmt::format("{} isolated impulses: left out", quality.impulses));
  }
  if (quality.quantisation_step) {
    const bool newtons = recording.conditions().quantity == ForceQuantity::Force_N;
    warn("quantised", fmt::format("forces are multiples of {:.3g}{}", *quality.quantisation_step, newtons ? " N" : ""));
  }
  for (const SuspiciousLine& line : analysis.frequency.spectral.suspicious_lines) {
    warn("suspicious_line", fmt::format("line at {:.4g} Hz: {}", line.frequency_Hz, line.reason));
  }
  const auto& spectral = analysis.frequency.spectral.value_Hz;
  const auto& counted = analysis.frequency.counted.value;
  if (spectral && counted && std::abs(*spectral / *counted - 1.0) > 0.05) {
    warn("frequencies_disagree",
         fmt::format("the spectrum shows {:.4g} Hz, counting slips {:.4g} Hz", *spectral, *counted));
  }
  const auto& bandwidth_Hz = recording.conditions().sensor_bandwidth_Hz;
  if (bandwidth_Hz && analysis.cycles.period_s) {
    const double lags = *analysis.cycles.period_s * 2.0 * std::numbers::pi * *bandwidth_Hz;
    if (lags < kForgotten) {
      warn("sensor_too_slow", fmt::format("a cycle lasts {:.2g} times the sensor's lag: one slip is hardly forgotten "
                                          "when the next begins, and little of the ramps is left to fit",
                                          lags));
    }
  }
  for (Warning& warning : warn_of(analysis.tests)) warnings.push_back(std::move(warning));
  if (analysis.fit) warnings.insert(warnings.end(), analysis.fit->warnings.begin(), analysis.fit->warnings.end());
  return warnings;
}

}  // namespace slipfit
