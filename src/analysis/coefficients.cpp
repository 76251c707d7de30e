#include "analysis/conclusions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/quantile.hpp"
#include "core/student.hpp"
#include "core/unknown.hpp"

namespace slipfit {
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
