#include "analysis/coefficients.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "analysis/statistics.hpp"
#include "core/unknown.hpp"
#include "fit/inference/student.hpp"

namespace slipfit {
namespace {

constexpr std::size_t kMostBlocks = 20;

/// Mean of a force that hangs together over times: the scatter is that of means over blocks of whole cycles or, without
/// cycles, of a twentieth of the recording.
Estimate mean_during_sliding(const Recording& recording, std::size_t cycles) {
  const std::span<const double> force = recording.force();
  const std::size_t blocks = cycles >= 2 ? std::min(kMostBlocks, cycles) : kMostBlocks;
  if (force.size() < 2 * blocks) return unknown("too few samples");
  std::vector<double> means;
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::size_t begin = i * force.size() / blocks;
    const auto block = force.subspan(begin, (i + 1) * force.size() / blocks - begin);
    means.push_back(std::accumulate(block.begin(), block.end(), 0.0) / static_cast<double>(block.size()));
  }
  const MeanAndSpread spread = describe(means);
  return fit::symmetric(spread.mean, spread.sd / std::sqrt(spread.count), spread.count - 1.0);
}

/// By the fit where it knows F_s: the sensor shows F_s - c V there, and samples miss the very peak.
std::optional<Estimate> fitted_static_friction(const Analysis& analysis) {
  const Parameter* const fitted = analysis.fit ? analysis.fit->find(ParameterId::StaticFriction) : nullptr;
  if (fitted == nullptr || !fitted->estimate.value || !fitted->estimate.ci95) return std::nullopt;
  const bool is_known = fitted->status != ParameterStatus::Unidentified && fitted->status != ParameterStatus::Bounded;
  return is_known ? std::optional(fitted->estimate) : std::nullopt;
}

/// The value of the first in an interval that holds both: the fit's takes it for granted that friction does not depend
/// on the speed, that of the peaks that a sample shows them.
Estimate in_both_intervals(Estimate estimate, const Estimate& other) {
  constexpr double kReach = 1.96;  // of a 95 % interval, in standard errors
  if (!estimate.ci95 || !other.ci95) return estimate;
  estimate.ci95 =
      Interval{std::min(estimate.ci95->low, other.ci95->low), std::max(estimate.ci95->high, other.ci95->high)};
  estimate.standard_error = 0.5 * (estimate.ci95->high - estimate.ci95->low) / kReach;
  return estimate;
}

/// Beside its scatter the highest sample of a slip errs by the noise, and by what the force rises in a sample.
Estimate mean_of_peaks(const Recording& recording, const Analysis& analysis) {
  const CycleStatistics& cycles = analysis.cycles;
  if (analysis.motion == MotionClass::SteadySliding) return unknown("steady sliding has no peaks");
  if (cycles.count < 2 || !cycles.peak_force || !cycles.peak_force_sd) return unknown("fewer than two slips");
  const double scatter = *cycles.peak_force_sd / std::sqrt(static_cast<double>(cycles.count));
  const double rise = cycles.force_drop && cycles.period_s && *cycles.period_s > 0.0
                          ? *cycles.force_drop * recording.sample_interval_s() / *cycles.period_s
                          : 0.0;
  const double se = std::hypot(scatter, analysis.quality.noise_rms, rise);
  return fit::symmetric(*cycles.peak_force, se, static_cast<double>(cycles.count) - 1.0);
}

Estimate over_load(Estimate force, double load_N, bool zero_is_known) {
  const auto divide = [load_N](std::optional<double>& number) {
    if (number) *number /= load_N;
  };
  divide(force.value);
  divide(force.standard_error);
  if (force.ci95) force.ci95 = Interval{force.ci95->low / load_N, force.ci95->high / load_N};
  if (force.value && !zero_is_known) force.note = "from the sensor's own zero, which --zero would state";
  return force;
}

}  // namespace

std::optional<Coefficients> find_coefficients(const Detected& detected, const Analysis& analysis) {
  const Conditions& conditions = detected.recording().conditions();
  const bool are_coefficients = conditions.quantity == ForceQuantity::FrictionCoefficient;
  if (!are_coefficients && !conditions.normal_force_N) return std::nullopt;
  const double load_N = are_coefficients ? 1.0 : *conditions.normal_force_N;
  const bool zero_is_known = conditions.zero_force_N.has_value();
  Coefficients coefficients;
  coefficients.static_first_peak = over_load(analysis.transients.breakaway_force, load_N, zero_is_known);
  Estimate peaks = mean_of_peaks(detected.recording(), analysis);
  if (auto fitted = fitted_static_friction(analysis)) peaks = in_both_intervals(*std::move(fitted), peaks);
  coefficients.static_mean_peak = over_load(std::move(peaks), load_N, zero_is_known);
  coefficients.kinetic_mean =
      over_load(mean_during_sliding(detected.recording(), analysis.cycles.count), load_N, zero_is_known);
  return coefficients;
}

}  // namespace slipfit
