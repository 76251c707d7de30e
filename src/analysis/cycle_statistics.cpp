#include "analysis/conclusions.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "analysis/detect.hpp"
#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "core/unknown.hpp"
#include "signal/smoothing.hpp"

namespace slipfit {

namespace {

/// Holds the median and the standard deviation that the median deviation from it gives.
struct RobustSpread {
  double middle = 0.0, sd = 0.0, count = 0.0;
};

RobustSpread robust_spread(const std::vector<double>& values) {
  const double middle = median(values);
  std::vector<double> off;
  off.reserve(values.size());
  for (const double value : values) off.push_back(std::abs(value - middle));
  return {middle, signal::kMedianToSigma * median(std::move(off)), static_cast<double>(values.size())};
}

/// Returns the median slope over the speed with its error.
Estimate stiffness_of(const RobustSpread& slopes_N_per_s, double speed_m_per_s) {
  constexpr double kMedianToMean = 1.2533;  // error of a median over that of a mean
  const double error = kMedianToMean * slopes_N_per_s.sd / std::sqrt(slopes_N_per_s.count);
  return symmetric(slopes_N_per_s.middle / speed_m_per_s, error / speed_m_per_s, slopes_N_per_s.count - 1.0);
}

/// Returns the sticks, none of them short, whose slope clearly differs from that of most: the steeper or the flatter
/// ones, whichever are more. None where they are so few that an impulse may have made them.
OtherSticks other_sticks(const std::vector<Rise>& rises, const RobustSpread& slopes_N_per_s, double speed_m_per_s) {
  std::vector<double> durations_s;
  durations_s.reserve(rises.size());
  for (const Rise& rise : rises) durations_s.push_back(rise.duration_s);
  const double usual_s = median(std::move(durations_s));
  const double negligible = thresholds::kNegligible * std::abs(slopes_N_per_s.middle);
  std::vector<double> lower, higher;
  for (const Rise& rise : rises) {
    if (!(rise.duration_s > 0.5 * usual_s)) continue;
    const double difference = rise.middle_N_per_s - slopes_N_per_s.middle;
    // The error of a line through noise grows as its length to the power -3/2.
    const double error = slopes_N_per_s.sd * std::max(1.0, std::pow(usual_s / rise.duration_s, 1.5));
    const bool differs = std::abs(difference) > std::max(thresholds::kSureSigmas * error, negligible);
    if (differs) (difference < 0.0 ? lower : higher).push_back(rise.middle_N_per_s);
  }
  const std::vector<double>& more = lower.size() > higher.size() ? lower : higher;
  constexpr double kFew = 0.05;
  if (static_cast<double>(more.size()) < std::max(3.0, kFew * slopes_N_per_s.count)) return {};
  return {more.size(), stiffness_of(robust_spread(more), speed_m_per_s)};
}

/// Adds the slopes of the sticks over the speed, in the middle three fifths of the time between slips.
void add_stick_stiffness(const Recording& recording, const Segmentation& segmentation, CycleStatistics& result) {
  if (!recording.conditions().speed_is_known) {
    result.stick_stiffness = unknown(kNoSpeed);
    return;
  }
  const std::vector<Rise> rises = rises_of(recording, segmentation);
  if (rises.size() < thresholds::kFewestSlips) {
    result.stick_stiffness = unknown("too few sticks");
    return;
  }
  std::vector<double> slopes;
  slopes.reserve(rises.size());
  for (const Rise& rise : rises) slopes.push_back(rise.middle_N_per_s);
  const RobustSpread spread = robust_spread(slopes);
  const double speed_m_per_s = recording.conditions().speed_m_per_s;
  result.stick_stiffness = stiffness_of(spread, speed_m_per_s);
  result.other_sticks = other_sticks(rises, spread, speed_m_per_s);
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
  add_stick_stiffness(recording, segmentation, result);
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
  const double of_speed = recording.conditions().relative_speed_error();
  const double relative = std::hypot(of_frequency, of_speed);
  derived.pattern_spacing_m.standard_error = spacing * relative;
  derived.impulse_rate_per_m.standard_error = relative / spacing;
  if (!frequency.quoted.ci95) return derived;
  // The ends of the interval of f, each farther off by what the speed may be off.
  const auto [low, high] = *frequency.quoted.ci95;
  const double frequency_Hz = *frequency.quoted.value;
  const auto reach = [&](double ratio) { return std::hypot(ratio - 1.0, kNormalQuantile * of_speed); };
  const double rate_per_m = 1.0 / spacing;
  derived.impulse_rate_per_m.ci95 = Interval{rate_per_m * std::max(0.0, 1.0 - reach(low / frequency_Hz)),
                                             rate_per_m * (1.0 + reach(high / frequency_Hz))};
  // Where f may be 0, the upper end is as far off as the lower one of f.
  const double longest = low > 0.0 ? frequency_Hz / low : 2.0 - low / frequency_Hz;
  derived.pattern_spacing_m.ci95 =
      Interval{spacing * std::max(0.0, 1.0 - reach(frequency_Hz / high)), spacing * (1.0 + reach(longest))};
  return derived;
}

namespace {

constexpr std::size_t kMostBlocks = 20;

/// The mean of a correlated force: the scatter is that of means over blocks of whole cycles or, without
/// cycles, of a twentieth of the samples.
Estimate mean_during_sliding(std::span<const double> force, std::size_t cycles) {
  const std::size_t blocks = cycles >= 2 ? std::min(kMostBlocks, cycles) : kMostBlocks;
  if (force.size() < 2 * blocks) return unknown("too few samples");
  std::vector<double> means;
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::size_t begin = i * force.size() / blocks;
    means.push_back(mean_of(force.subspan(begin, (i + 1) * force.size() / blocks - begin)));
  }
  const MeanAndSpread spread = describe(means);
  return symmetric(spread.mean, spread.sd / std::sqrt(spread.count), spread.count - 1.0);
}

/// Returns the fitted static friction if the fit determines F_s: the sensor measures F_s - c V at the peak, and samples
/// miss the exact peak.
std::optional<Estimate> fitted_static_friction(const Analysis& analysis) {
  const Parameter* const fitted = analysis.fit ? analysis.fit->find(ParameterId::StaticFriction) : nullptr;
  if (fitted == nullptr || !fitted->estimate.value || !fitted->estimate.ci95) return std::nullopt;
  const bool is_known = fitted->status != ParameterStatus::Unidentified && fitted->status != ParameterStatus::Bounded;
  return is_known ? std::optional(fitted->estimate) : std::nullopt;
}

/// The value of the first in an interval that holds both: the fit's takes it for granted that friction does not depend
/// on the speed, that of the peaks that a sample shows them.
Estimate in_both_intervals(Estimate estimate, const Estimate& other) {
  if (!estimate.ci95 || !other.ci95) return estimate;
  estimate.ci95 =
      Interval{std::min(estimate.ci95->low, other.ci95->low), std::max(estimate.ci95->high, other.ci95->high)};
  estimate.standard_error = 0.5 * (estimate.ci95->high - estimate.ci95->low) / kNormalQuantile;
  return estimate;
}

/// Returns the mean of the peaks; its error includes scatter, the noise of the highest sample, and the rise of the
/// force within a sample interval.
Estimate mean_of_peaks(const Recording& recording, const Analysis& analysis) {
  const CycleStatistics& cycles = analysis.cycles;
  if (analysis.motion == MotionClass::SteadySliding) return unknown("steady sliding has no peaks");
  if (cycles.count < 2 || !cycles.peak_force || !cycles.peak_force_sd) return unknown("fewer than two slips");
  const double scatter = *cycles.peak_force_sd / std::sqrt(static_cast<double>(cycles.count));
  const double rise = cycles.force_drop && cycles.period_s && *cycles.period_s > 0.0
                          ? *cycles.force_drop * recording.sample_interval_s() / *cycles.period_s
                          : 0.0;
  const double se = std::hypot(scatter, analysis.quality.noise_rms, rise);
  return symmetric(*cycles.peak_force, se, static_cast<double>(cycles.count) - 1.0);
}

Estimate over_load(Estimate force, double load_N, bool zero_is_known) {
  const auto divide = [load_N](std::optional<double>& number) {
    if (number) *number /= load_N;
  };
  divide(force.value);
  divide(force.standard_error);
  if (force.ci95) force.ci95 = Interval{force.ci95->low / load_N, force.ci95->high / load_N};
  if (force.value && !zero_is_known) force.note = "relative to the sensor's own zero (--zero states it)";
  return force;
}

/// The requirements of the standards that a recording can show: ASTM D1894-14, 8 to 10; ISO 8295:1995, 6 to 9.
struct Standard {
  const char* name;
  const char* prescribes;
  double speed_m_per_s, speed_tolerance_m_per_s;
  double load_N, load_tolerance_N;
  double travel_m;  ///< over which the kinetic force is averaged
};

constexpr std::array kStandards = std::to_array<Standard>(
    {{"ASTM D1894",
      "a sled of 200 g and 63.5 mm square at 150 mm/min; static: the first maximum; kinetic: the mean over 130 mm",
      0.150 / 60.0, 0.030 / 60.0, 1.961, 0.049, 0.130},
     {"ISO 8295",
      "1.96 N on 40 cm^2 at 100 mm/min, after 15 s at rest; static: the first maximum; kinetic: the mean over the "
      "following 60 mm",
      0.100 / 60.0, 0.010 / 60.0, 1.96, 0.02, 0.060}});

/// The sliding part of a recording: force in its own unit, and frequency of the slips.
struct Sliding {
  const Recording& recording;
  std::size_t cycles = 0;
  bool slips = false;

  /// Mean over samples [begin, end).
  [[nodiscard]] Estimate mean(std::size_t begin, std::size_t end) const {
    const double share = static_cast<double>(end - begin) / static_cast<double>(recording.size());
    return mean_during_sliding(recording.force().subspan(begin, end - begin),
                               static_cast<std::size_t>(share * static_cast<double>(cycles)));
  }
};

std::vector<std::string> differences(const Standard& standard, const Sliding& sliding,
                                     const std::optional<double>& load_N) {
  const double speed = sliding.recording.conditions().speed_m_per_s;
  const double travel_m = speed * sliding.recording.duration_s();
  std::vector<std::string> differs;
  if (std::abs(speed - standard.speed_m_per_s) > standard.speed_tolerance_m_per_s) {
    differs.push_back(fmt::format("driven at {:.3g} mm/min, not {:.3g}", 6e4 * speed, 6e4 * standard.speed_m_per_s));
  }
  if (load_N && std::abs(*load_N - standard.load_N) > standard.load_tolerance_N) {
    differs.push_back(fmt::format("pressed with {:.3g} N, not {:.3g}", *load_N, standard.load_N));
  }
  if (travel_m < standard.travel_m) {
    differs.push_back(fmt::format("sliding distance {:.3g} mm of {:.3g}", 1e3 * travel_m, 1e3 * standard.travel_m));
  }
  if (sliding.slips) differs.emplace_back("during stick-slip the mean force is not the kinetic friction");
  return differs;
}

/// A mean over a recording whose level has a trend: in an interval that includes the levels of all its parts.
Estimate with_trend(Estimate mean, const Analysis& analysis) {
  if (!analysis.fit || !analysis.fit->level_trend.level_range || !mean.ci95) return mean;
  const Interval& range = *analysis.fit->level_trend.level_range;
  mean.ci95 = Interval{mean.ci95->low + range.low, mean.ci95->high + range.high};
  mean.standard_error = 0.5 * (mean.ci95->high - mean.ci95->low) / kNormalQuantile;
  return mean;
}

}  // namespace

std::optional<Coefficients> find_coefficients(const Detected& detected, const Analysis& analysis) {
  const Recording& recording = detected.recording();
  const Conditions& conditions = recording.conditions();
  const bool are_coefficients = conditions.quantity == ForceQuantity::FrictionCoefficient;
  if (!are_coefficients && !conditions.normal_force_N) return std::nullopt;
  const double load_N = are_coefficients ? 1.0 : *conditions.normal_force_N;
  const auto of = [&](Estimate force) {
    return over_load(std::move(force), load_N, conditions.zero_force_N.has_value());
  };
  const Sliding sliding{recording, analysis.cycles.count, analysis.motion == MotionClass::StickSlip};
  const std::size_t size = recording.size();
  Coefficients coefficients;
  coefficients.static_first_peak = of(analysis.transients.breakaway_force);
  Estimate peaks = with_trend(mean_of_peaks(recording, analysis), analysis);
  if (auto fitted = fitted_static_friction(analysis)) peaks = in_both_intervals(*std::move(fitted), peaks);
  if (peaks.value && analysis.cycles.peak_force_sd)
    coefficients.static_peak_sd = *analysis.cycles.peak_force_sd / load_N;
  coefficients.static_mean_peak = of(std::move(peaks));
  coefficients.kinetic_mean = of(with_trend(mean_during_sliding(recording.force(), analysis.cycles.count), analysis));
  coefficients.kinetic_first_third = of(sliding.mean(0, size / 3));
  coefficients.kinetic_last_third = of(sliding.mean(size - size / 3, size));
  coefficients.kinetic_sd = describe(recording.force()).sd / load_N;
  if (!conditions.speed_is_known) return coefficients;
  for (const Standard& standard : kStandards) {
    const double end_s = recording.time_s().front() + standard.travel_m / conditions.speed_m_per_s;
    const auto end = std::upper_bound(recording.time_s().begin(), recording.time_s().end(), end_s);
    coefficients.standards.push_back({standard.name, standard.prescribes, coefficients.static_first_peak,
                                      of(sliding.mean(0, static_cast<std::size_t>(end - recording.time_s().begin()))),
                                      differences(standard, sliding, conditions.normal_force_N)});
  }
  return coefficients;
}

}  // namespace slipfit
