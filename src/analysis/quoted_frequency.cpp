#include "analysis/conclusions.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "analysis/detect.hpp"
#include "analysis/estimate.hpp"
#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "signal/smoothing.hpp"

namespace slipfit {
namespace {

struct Onset {
  double index = 0.0;  ///< number of the cycle, missing ones counted
  double time_s = 0.0;
  std::optional<double> counted;  ///< steps from the one before by the table, where cycles between were left aside
};

std::vector<Onset> onsets_of(const FitResult& fit) {
  std::vector<Onset> onsets;
  std::vector<double> steps_s;
  double rows = 1.0;
  bool aside = false;
  for (const Cycle& cycle : fit.cycles) {
    aside = aside || !cycle.selected;
    if (cycle.used && !onsets.empty()) steps_s.push_back((*cycle.onset_s - onsets.back().time_s) / rows);
    if (cycle.used) onsets.push_back({0.0, *cycle.onset_s, aside ? std::optional(rows) : std::nullopt});
    if (cycle.used) aside = false;
    rows = cycle.used ? 1.0 : rows + 1.0;
  }
  const double period_s = signal::median(std::move(steps_s));
  for (std::size_t i = 1; i < onsets.size(); ++i) {
    // From one to the next: a period that drifts does not add up. Over many cycles that scatter only counting helps.
    const double steps = std::round((onsets[i].time_s - onsets[i - 1].time_s) / period_s);
    onsets[i].index = onsets[i - 1].index + onsets[i].counted.value_or(std::max(1.0, steps));
  }
  return onsets;
}

/// Slope of the least-squares line through the onsets, and its standard error: larger where neighbours err together
/// (short sticks hand their errors on).
struct Line {
  double period_s = 0.0;
  double standard_error_s = 0.0;
};

Line line_through(const std::vector<Onset>& onsets) {
  const LineSums line = line_sums(
      onsets.size(), [&](std::size_t i) { return onsets[i].index; }, [&](std::size_t i) { return onsets[i].time_s; });
  double rest = 0.0, product = 0.0, previous_s = 0.0;
  for (const Onset& onset : onsets) {
    const double residual_s = onset.time_s - line.at(onset.index);
    rest += residual_s * residual_s;
    product += residual_s * previous_s;
    previous_s = residual_s;
  }
  const double correlation = rest > 0.0 ? std::clamp(product / rest, 0.0, 0.9) : 0.0;
  const double fewer = (1.0 + correlation) / (1.0 - correlation);
  return {line.slope(), std::sqrt(fewer * rest / (line.count - 2.0) / line.square)};
}

/// Returns true if the onset forces differ no more than their errors, and neighbouring periods are correlated like
/// those of even onsets with independent timing errors (-1/2, with a standard error of 0.7 / sqrt(count)); scatter of
/// the static friction gives values near +1/2.
bool is_regular(const FitDiagnostics& diagnostics, const std::vector<Onset>& onsets, double period_s) {
  if (diagnostics.onset_force_spread > thresholds::kOrdinarySpread * diagnostics.onset_force_error) return false;
  double product = 0.0, square = 0.0, previous = 0.0, count = 0.0;
  for (std::size_t i = 1; i < onsets.size(); ++i) {
    const double steps = onsets[i].index - onsets[i - 1].index;
    const double deviation = steps == 1.0 ? onsets[i].time_s - onsets[i - 1].time_s - period_s : 0.0;
    square += deviation * deviation;
    product += deviation * previous;
    previous = deviation;
    count += 1.0;
  }
  return product <= (-0.5 + 0.9 / std::sqrt(count)) * square;
}

/// Standard error over mean of the time that a slip's drop takes to build up again, on average over the cycles in the
/// fit and those left aside, which scatter alike.
double recovery_error(const FitResult& fit) {
  double count = 0.0, mean = 0.0, square = 0.0, aside = 0.0;
  for (const Cycle& cycle : fit.cycles) {
    if (!cycle.selected) aside += 1.0;
    if (!cycle.used) continue;
    count += 1.0;
    const double step = *cycle.recovery_s - mean;
    mean += step / count;
    square += step * (*cycle.recovery_s - mean);
  }
  return std::sqrt(square / (count - 1.0) / (count + aside)) / mean;
}

}  // namespace

std::optional<Estimate> fitted_frequency(const FitResult& fit, const Recording& recording) {
  const std::vector<Onset> onsets = onsets_of(fit);
  if (onsets.size() < thresholds::kFewestCycles) return std::nullopt;
  const auto count = static_cast<double>(onsets.size());
  const Line line = line_through(onsets);
  // The first and the last slip are timed to a step of the clock, evenly distributed.
  const double mean_s = (onsets.back().time_s - onsets.front().time_s) / onsets.back().index;
  const double timing = recording.sample_interval_s() / mean_s / std::sqrt(6.0) / count;
  if (!is_regular(fit.diagnostics, onsets, line.period_s)) {
    const double frequency_Hz = 1.0 / mean_s;
    return symmetric(frequency_Hz, std::hypot(recovery_error(fit), timing) * frequency_Hz, count - 1.0);
  }
  // Between two samples of a hardly sampled slip the errors of regular cycles are no chance: they repeat.
  if (fit.diagnostics.samples_per_slip < thresholds::kShapeSamples) return std::nullopt;
  // Jumps of a sensor at the contact are timed to a step, and the error of regular ones may repeat.
  const double step = recording.conditions().force_view == ForceView::Contact ? 0.5 * timing : 0.0;
  const double frequency_Hz = 1.0 / line.period_s;
  return symmetric(frequency_Hz, std::hypot(line.standard_error_s / line.period_s, step) * frequency_Hz, count - 2.0);
}

namespace {

/// Returns the relative difference of the two frequencies, or nothing if one of them is missing.
std::optional<double> relative_difference(const SpectralFrequency& spectral, const Estimate& counted) {
  if (!spectral.value_Hz || !counted.value) return std::nullopt;
  return std::abs(*spectral.value_Hz / *counted.value - 1.0);
}

/// Harmonic least squares uses every sample, onsets what the slips show of them: on regular cycles it is two to five
/// times as exact (docs/accuracy.md), unless hum or drift, which the fit allows for and the spectrum does not, are in
/// its error. Where the two contradict each other the fit is quoted: it distinguishes slips from other repetitions.
bool is_sharper(const SpectralFrequency& spectral, const Estimate& fitted) {
  if (!spectral.value_Hz || !spectral.regular_standard_error_Hz) return false;
  const double difference_Hz = std::abs(*spectral.value_Hz - *fitted.value);
  // Alike: an interval that scatter has made wide holds lines that are not the slips'.
  return *spectral.regular_standard_error_Hz < *fitted.standard_error &&
         difference_Hz < thresholds::kAlike * *fitted.value;
}

/// Peak to peak of the sine at this frequency.
double swing_at(const Recording& recording, double frequency_Hz) {
  const std::span<const double> time_s = recording.time_s();
  const std::span<const double> force = recording.force();
  const double mean = mean_of(force);
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    sum += (force[i] - mean) * std::polar(1.0, -2.0 * std::numbers::pi * frequency_Hz * (time_s[i] - time_s[0]));
  }
  return 4.0 * std::abs(sum) / static_cast<double>(force.size());
}

/// Returns true if a spectral line is the frequency of the slips or one of its harmonics.
bool is_of_slips(double line_Hz, const Estimate& slips) {
  if (!slips.value) return false;
  const double order = std::max(1.0, std::round(line_Hz / *slips.value));
  const double scatter = 3.0 * slips.standard_error.value_or(0.0) / *slips.value;
  return std::abs(line_Hz / (order * *slips.value) - 1.0) < std::max(thresholds::kAlike, scatter);
}

/// Returns true if a line is a multiple of the frequency of the slips within its accuracy; at high multiples every line
/// would be.
bool is_multiple_of(double line_Hz, const Estimate& slips, double resolution_Hz) {
  constexpr double kDistinct = 0.1;  // of the distance between multiples
  if (!slips.value || !slips.standard_error) return false;
  const double order = std::max(1.0, std::round(line_Hz / *slips.value));
  const double known_Hz = std::max(resolution_Hz, 3.0 * order * *slips.standard_error);
  return std::abs(line_Hz - order * *slips.value) < std::min(known_Hz, kDistinct * *slips.value);
}

/// Returns the lines of the spectrum that do not belong to the slips.
std::vector<SuspiciousLine> suspicious_lines_of(const Recording& recording, const SpectralFrequency& spectral,
                                                const Estimate& quoted) {
  std::vector<SuspiciousLine> lines = spectral.suspicious_lines;
  if (spectral.value_Hz && !is_of_slips(*spectral.value_Hz, quoted)) {
    const char* const reason = quoted.value
                                   ? "not the slips: pick-up, ripple of the drive, ringing or a wave of the force level"
                                   : "periodic without slips: pick-up, ripple of the drive or an oscillation";
    lines.push_back({*spectral.value_Hz, reason, swing_at(recording, *spectral.value_Hz)});
  }
  return lines;
}

/// Slips of a fit that is the model's: its cycles, or the spectrum where these are regular and it is the sharper.
std::optional<FrequencyReport> of_fit(const Recording& recording, const Signals& signals, const FitResult& fit) {
  const auto fitted = fitted_frequency(fit, recording);
  if (!fitted) return std::nullopt;
  FrequencyReport report;
  report.method = FrequencyMethod::FittedCycles;
  report.quoted = *fitted;
  if (is_sharper(signals.spectral, *fitted)) {
    report.method = FrequencyMethod::HarmonicLeastSquares;
    const double freedom = std::max(1.0, static_cast<double>(signals.segmentation.slips.size()) - 3.0);
    report.quoted = symmetric(*signals.spectral.value_Hz, *signals.spectral.regular_standard_error_Hz, freedom);
  }
  return report;
}

/// A line of the mains swings far enough to be counted as slips.
bool hum_makes_falls(const Signals& signals) {
  const auto& lines = signals.spectral.suspicious_lines;
  return std::ranges::any_of(lines,
                             [&](const SuspiciousLine& line) { return line.swing > signals.segmentation.hysteresis; });
}

/// Returns the count with an interval that includes the frequency of the spectrum.
Estimate reaching(Estimate counted, const SpectralFrequency& spectral) {
  const double spectral_Hz = *spectral.value_Hz;
  counted.note = fmt::format("the spectrum shows {:.4g} Hz, which the interval includes", spectral_Hz);
  if (!counted.ci95) return counted;
  // The line's own error, and that of the scatter of the slips, which the count shows.
  const double half_Hz =
      std::hypot(2.0 * spectral.standard_error_Hz.value_or(0.0), 0.5 * (counted.ci95->high - counted.ci95->low));
  counted.ci95->low = std::min(counted.ci95->low, spectral_Hz - half_Hz);
  counted.ci95->high = std::max(counted.ci95->high, spectral_Hz + half_Hz);
  const double longer = std::max(*counted.value - counted.ci95->low, counted.ci95->high - *counted.value);
  counted.standard_error = std::max(*counted.standard_error, longer / kNormalQuantile);
  return counted;
}

/// Slips or swings without a fit: the spectrum where they are regular and it shows their frequency, else the count.
FrequencyReport of_trace(const Recording& recording, const Signals& signals, const Classification& classification) {
  const SpectralFrequency& spectral = signals.spectral;
  FrequencyReport report;
  const Estimate counted = count_frequency(recording, signals.segmentation);
  const Intervals intervals = intervals_of(recording, signals.segmentation);
  const MeanAndSpread interval = describe(intervals.seconds);
  const std::optional<double> difference = relative_difference(spectral, counted);
  const bool agree = difference && *difference < thresholds::kAlike;
  const bool regular =
      intervals.broken == 0 && interval.count >= 2.0 && interval.sd < thresholds::kClockScatter * interval.mean;
  // A repetition near the count may be that of the slips, with some hidden or made by hum. One far from it is another
  // thing: pick-up, ringing.
  const bool near = difference && *difference < thresholds::kAnotherThing;
  const bool contradict = !agree && ((near && may_be_hum(signals)) || (!difference && hum_makes_falls(signals)));
  // The count may be of noise or of hum.
  const bool hidden = classification.motion == MotionClass::OscillatorySlip && !agree &&
                      !(keeps_rhythm(signals.segmentation) && !is_faint(signals.segmentation) && !may_be_hum(signals));
  if (classification.dies_out && !agree) {
    report.quoted.note = "the oscillation decays, and spectrum and count disagree";
  } else if (spectral.value_Hz && spectral.standard_error_Hz && ((agree && regular) || hidden)) {
    report.method = FrequencyMethod::HarmonicLeastSquares;
    report.quoted = symmetric(*spectral.value_Hz, *spectral.standard_error_Hz, std::max(1.0, interval.count - 1.0));
    if (!agree && counted.value)
      report.quoted.note = fmt::format("{:.4g} force drops per second were counted", *counted.value);
  } else if (counted.value && !contradict) {
    report.method = FrequencyMethod::SlipCounting;
    report.quoted = near && !agree ? reaching(counted, spectral) : counted;
    if (difference && !near) report.quoted.note = fmt::format("the spectrum shows {:.4g} Hz", *spectral.value_Hz);
  } else {
    report.quoted.note = "hum as large as the slips may have added or concealed some, and the spectrum does not agree";
  }
  return report;
}

}  // namespace

FrequencyReport quote_frequency(const Recording& recording, const Signals& signals,
                                const Classification& classification, const FitResult* fit) {
  const MotionClass motion = classification.motion;
  const bool slides = motion == MotionClass::StickSlip || motion == MotionClass::OscillatorySlip;
  const Estimate counted = count_frequency(recording, signals.segmentation);
  FrequencyReport report;
  report.quoted.note = motion == MotionClass::SteadySliding ? "steady sliding has no slips"
                                                            : "no slips were found, so no frequency is quoted";
  if (slides) {
    const Intervals intervals = intervals_of(recording, signals.segmentation);
    // Slips that scatter are counted: what the fit's cycles cause is another mean than that of those that came.
    const MeanAndSpread interval = describe(intervals.seconds);
    const bool scatters = interval.count > 7.0 && interval.sd > thresholds::kCounted * interval.mean;
    const bool usable = fit != nullptr && motion == MotionClass::StickSlip && intervals.broken == 0 && !scatters;
    const bool has_strokes = recording.provenance().strokes > 0;  // each of them begins with a phase of its own
    const std::optional<FrequencyReport> fitted =
        usable && !has_strokes ? of_fit(recording, signals, *fit) : std::nullopt;
    if (motion == MotionClass::OscillatorySlip && pace_changes(signals.segmentation)) {
      report.quoted.note = "the frequency of the oscillation changes: analyse each part with --window T0:T1";
    } else if (has_strokes) {
      report.method = FrequencyMethod::SlipCounting;
      report.quoted = counted;
    } else {
      report = fitted ? *fitted : of_trace(recording, signals, classification);
      constexpr double kMost = 0.8;  // cycles that the fit leaves out may have another period
      if (fitted && counted.value && used_share(*fit) < kMost) report.quoted = including(report.quoted, *counted.value);
    }
  }
  report.spectral = signals.spectral;
  report.counted = counted;
  std::erase_if(report.spectral.suspicious_lines, [&](const SuspiciousLine& line) {
    return is_multiple_of(line.frequency_Hz, report.quoted, 1.0 / recording.duration_s());
  });
  report.lines = suspicious_lines_of(recording, report.spectral, report.quoted);
  return report;
}

}  // namespace slipfit
