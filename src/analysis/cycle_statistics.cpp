#include "analysis/conclusions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/slip_intervals.hpp"
#include "core/line_sums.hpp"
#include "core/quantile.hpp"
#include "core/student.hpp"
#include "core/thresholds.hpp"
#include "core/unknown.hpp"
#include "signal/robust.hpp"

namespace slipfit {

namespace {

/// Returns the slope of the sticks over the speed: median and scatter in the middle three fifths of the time between
/// slips.
Estimate stick_stiffness(const Recording& recording, const Segmentation& segmentation) {
  constexpr std::size_t kFewestSamples = 5;
  const double speed_m_per_s = recording.conditions().speed_m_per_s;
  if (!recording.conditions().speed_is_known) return unknown(kNoSpeed);
  std::vector<double> slopes;
  for (std::size_t i = 1; i < segmentation.slips.size(); ++i) {
    const std::size_t begin = segmentation.slips[i - 1].trough;
    const std::size_t fifth = (segmentation.slips[i].peak - begin) / 5;
    if (3 * fifth < kFewestSamples) continue;
    const auto of = [&](std::span<const double> values) { return values.subspan(begin + fifth, 3 * fifth); };
    slopes.push_back(line_sums(of(recording.time_s()), of(recording.force())).slope() / speed_m_per_s);
  }
  if (slopes.size() < thresholds::kFewestSlips) return unknown("too few sticks");
  const double middle = signal::median(slopes);
  std::vector<double> off;
  off.reserve(slopes.size());
  for (const double slope : slopes) off.push_back(std::abs(slope - middle));
  constexpr double kMedianToSe = signal::kMedianToSigma * 1.2533;  // error of a median over that of a mean
  const auto count = static_cast<double>(slopes.size());
  return symmetric(middle, kMedianToSe * signal::median(std::move(off)) / std::sqrt(count), count - 1.0);
}

/// Returns the statistics with the slip and stick times of the fitted cycles.
CycleStatistics with_stick_times(CycleStatistics result, const FitResult& fit) {
  std::vector<double> slips;
  for (const Cycle& cycle : fit.cycles) {
    if (cycle.used) slips.push_back(*cycle.end_s - *cycle.onset_s);
  }
  result.used = slips.size();
  if (fit.tier == Tier::Sawtooth || !result.period_s) return result;
  result.slip_time_s = describe(slips).mean;
  result.stick_time_s = std::max(0.0, *result.period_s - *result.slip_time_s);
  result.sticking_degree = *result.stick_time_s / *result.period_s;
  return result;
}

/// Slips that keep time with the drive: one to so many of its periods, or two to each (friction that goes as the square
/// of an excitation).
bool is_clocked(double drive_period_s, const Estimate& slips_Hz) {
  if (!slips_Hz.value || !slips_Hz.standard_error) return false;
  const double periods = 1.0 / (*slips_Hz.value * drive_period_s);
  const double nearest = periods < 0.75 ? 0.5 : std::round(periods);
  const double sure = *slips_Hz.standard_error / *slips_Hz.value;
  return nearest <= thresholds::kMostDriveSteps && sure * nearest < thresholds::kSureOfDrive &&
         std::abs(periods / nearest - 1.0) < 2.0 * sure + thresholds::kMainsRhythm;
}

}  // namespace

Regularity regularity_of(const CycleStatistics& cycles, const Estimate& slips_Hz, const Conditions& conditions) {
  if (cycles.period_cv.value_or(1.0) > thresholds::kSameRhythm) return Regularity::Irregular;
  const bool clocked = conditions.drive_period_s && is_clocked(*conditions.drive_period_s, slips_Hz);
  return clocked ? Regularity::Clocked : Regularity::Regular;
}

CycleStatistics summarise_cycles(const Recording& recording, const Segmentation& segmentation, const FitResult* fit) {
  CycleStatistics result;
  result.count = segmentation.slips.size();
  result.minor = segmentation.minor;
  if (segmentation.slips.empty()) return result;
  std::vector<double> peaks;
  std::vector<double> troughs;
  std::vector<double> drops;
  std::vector<double> falls_s;
  const std::size_t first = segmentation.slips.size() > 3 ? 1 : 0;  // the first slip starts from rest
  for (std::size_t i = first; i < segmentation.slips.size(); ++i) {
    peaks.push_back(segmentation.slips[i].peak_force);
    troughs.push_back(segmentation.slips[i].trough_force);
    drops.push_back(segmentation.slips[i].drop());
    falls_s.push_back(segmentation.slips[i].fall_s / 0.6);  // measured from 80 % to 20 %
  }
  result.fall_time_s = signal::median(std::move(falls_s));
  const MeanAndSpread peak = describe(peaks);
  const MeanAndSpread drop = describe(drops);
  result.peak_force = peak.mean;
  result.trough_force = describe(troughs).mean;
  result.force_drop = drop.mean;
  if (peak.count > 1.0) {
    result.peak_force_sd = peak.sd;
    result.force_drop_sd = drop.sd;
  }
  result.stick_stiffness = stick_stiffness(recording, segmentation);
  const MeanAndSpread interval = describe(intervals_of(recording, segmentation).seconds);
  if (interval.count >= 1.0) result.period_s = interval.mean;
  if (interval.count >= 2.0) {
    result.period_sd_s = interval.sd;
    result.period_cv = interval.sd / interval.mean;
    result.drop_cv = drop.sd / drop.mean;
  }
  return fit != nullptr ? with_stick_times(result, *fit) : result;
}

Derived with_measured_spacing(Derived derived, const Recording& recording, const FrequencyReport& frequency,
                              const CycleStatistics& cycles) {
  if (!frequency.quoted.value) {
    derived.pattern_spacing_m.note = derived.impulse_rate_per_m.note = "no frequency, no spacing";
    return derived;
  }
  if (!recording.conditions().speed_is_known) {
    derived.pattern_spacing_m.note = derived.impulse_rate_per_m.note = kNoSpeed;
    return derived;
  }
  const double speed = recording.conditions().speed_m_per_s;
  const double spacing = speed / *frequency.quoted.value;
  derived.pattern_spacing_m = {spacing, std::nullopt, std::nullopt, "V / f at the measured speed"};
  derived.impulse_rate_per_m = {1.0 / spacing, std::nullopt, std::nullopt, {}};
  if (cycles.period_sd_s) derived.pattern_spacing_sd_m = speed * *cycles.period_sd_s;
  if (!frequency.quoted.standard_error) return derived;
  const double of_frequency = *frequency.quoted.standard_error / *frequency.quoted.value;
  const double of_speed = recording.conditions().speed_standard_error_m_per_s.value_or(0.0) / speed;
  const double relative = std::hypot(of_frequency, of_speed);
  const double freedom = std::max(1.0, static_cast<double>(cycles.count) - 3.0);
  derived.pattern_spacing_m = symmetric(spacing, spacing * relative, freedom);
  derived.pattern_spacing_m.note = "V / f at the measured speed";
  derived.impulse_rate_per_m = symmetric(1.0 / spacing, relative / spacing, freedom);
  return derived;
}

}  // namespace slipfit
