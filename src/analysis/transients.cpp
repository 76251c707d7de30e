#include "analysis/conclusions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/ring_down.hpp"
#include "analysis/slip_shape.hpp"
#include "core/line_sums.hpp"
#include "core/quantile.hpp"
#include "core/student.hpp"
#include "core/thresholds.hpp"
#include "core/unknown.hpp"
#include "signal/smoothing.hpp"
#include "signal/turning_points.hpp"

namespace slipfit {
namespace {

/// The trace at one time scale, one mean a sample from `half` samples on.
struct Trace {
  std::vector<double> force;
  std::size_t half = 0;
  double noise = 0.0;
};

/// So many samples that the turning points of the run-up exceed the noise, but short against it.
Trace smoothed(const Detected& detected) {
  const std::span<const double> force = detected.whole->force();
  const Segmentation& slips = detected.signals.segmentation;
  const std::size_t width = slips.slips.empty() ? std::max<std::size_t>(1, force.size() / 500) : slips.smoothed_over;
  std::vector<double> means = signal::RunningMeans(force).over(std::min(width, force.size()));
  const double noise = detected.whole_quality.noise_rms / std::sqrt(static_cast<double>(width));
  return {std::move(means), width / 2, noise};
}

/// The part of a recording from the lowest force to the first peak.
struct RunUp {
  std::size_t begin = 0;
  std::size_t peak = 0;
  double rise = 0.0;
};

/// The first rise that is much larger than the sticks between the slips (or, without slips, than what comes after it).
std::optional<RunUp> first_large_rise(const Trace& trace, double drop) {
  const auto [low, high] = std::ranges::minmax_element(trace.force);
  const double range = *high - *low;
  const double swing = std::max(drop > 0.0 ? 0.25 * drop : 0.1 * range, 8.0 * trace.noise);
  const double least = std::max(thresholds::kRunUp * drop, thresholds::kNoiseDrop * trace.noise);
  signal::TurningPoints turns(swing);
  std::size_t lowest = 0;  // of those before `looked`
  std::size_t looked = 0;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < trace.force.size(); ++i) {
    turns.add(i, trace.force[i]);
    if (turns.falls().size() == seen) continue;
    const std::size_t peak = turns.falls()[seen++].peak;
    for (; looked < peak; ++looked) lowest = trace.force[looked] < trace.force[lowest] ? looked : lowest;
    const double rise = trace.force[peak] - trace.force[lowest];
    if (rise > std::max(least, drop > 0.0 ? 0.0 : 0.5 * range)) return RunUp{lowest, peak, rise};
  }
  return std::nullopt;
}

/// Returns the loading before the first slip of a recording that starts at rest; without stick-slip the force has to
/// stay high after the first peak.
std::optional<RunUp> run_up(const Detected& detected, const Trace& trace, MotionClass motion) {
  const std::vector<DetectedSlip>& slips = detected.signals.segmentation.slips;
  const std::optional<RunUp> ramp = first_large_rise(trace, median_drop(detected.signals.segmentation));
  if (!ramp) return std::nullopt;
  if (motion == MotionClass::StickSlip) {
    const std::size_t first = detected.sample_of(slips.front().trough);
    return ramp->peak + trace.half < first ? ramp : std::nullopt;
  }
  const double low = trace.force[ramp->begin] + 0.25 * ramp->rise;
  const auto behind = trace.force.begin() + static_cast<std::ptrdiff_t>(ramp->peak);
  const auto fallen = std::count_if(behind, trace.force.end(), [&](double force) { return force < low; });
  const auto all = static_cast<double>(trace.force.end() - behind);
  return static_cast<double>(fallen) < thresholds::kReleased * all ? ramp : std::nullopt;
}

/// The first peak over the mean of a hundredth of the ramp: noise lifts the highest sample.
double peak_force(const Recording& recording, const Trace& trace, const RunUp& ramp) {
  const std::size_t width = std::max<std::size_t>(1, (ramp.peak - ramp.begin) / 100);
  const std::size_t at = ramp.peak + trace.half;
  const std::size_t begin = at - std::min(at, 2 * width);
  const auto around = recording.force().subspan(begin, std::min(recording.size() - begin, 4 * width));
  const std::vector<double> means = signal::RunningMeans(around).over(std::min(width, around.size()));
  return *std::ranges::max_element(means);
}

/// Slope of the ramp from 20 % to 80 % of the rise over the speed. The interval holds how the slope changes on the way:
/// its scatter between fifths of the ramp.
Estimate loading_stiffness(const Recording& recording, const Trace& trace, const RunUp& ramp) {
  const auto reaches = [&](double share) {
    std::size_t i = ramp.begin;
    while (trace.force[i] < trace.force[ramp.begin] + share * ramp.rise) ++i;
    return i + trace.half;
  };
  const std::size_t begin = reaches(0.2);
  const std::size_t count = reaches(0.8) - begin + 1;
  constexpr std::size_t kParts = 5;
  if (count < 4 * kParts) return unknown("the loading ramp has too few samples");
  if (!recording.conditions().speed_is_known) return unknown(kNoSpeed);
  const auto part = [&](std::size_t from, std::size_t samples) {
    return line_sums(recording.time_s().subspan(begin + from, samples),
                     recording.force().subspan(begin + from, samples))
        .slope();
  };
  std::vector<double> slopes;
  for (std::size_t i = 0; i < kParts; ++i) slopes.push_back(part(i * (count / kParts), count / kParts));
  const double speed = recording.conditions().speed_m_per_s;
  const double se = describe(slopes).sd / std::sqrt(static_cast<double>(kParts));
  return symmetric(part(0, count) / speed, se / speed, kParts - 1.0);
}

/// After the release where there is one, after the first peak of a motion that died out otherwise.
std::optional<RingDown> ring_down_of(const Detected& detected, MotionClass motion, const std::optional<RunUp>& ramp) {
  if (motion == MotionClass::StickSlip) return ring_down_after_release(detected);
  if (!ramp) return std::nullopt;
  const double noise = detected.whole_quality.noise_rms;
  return find_ring_down(*detected.whole, ramp->peak, noise, std::max(0.3 * ramp->rise, thresholds::kNoiseDrop * noise));
}

}  // namespace

Transients find_transients(const Detected& detected, MotionClass motion) {
  const Trace trace = smoothed(detected);
  const std::optional<RunUp> ramp = run_up(detected, trace, motion);
  constexpr double kManyFreedoms = 100.0;
  Transients transients;
  transients.loading_stiffness_N_per_m = transients.breakaway_force = unknown("the recording contains no loading ramp");
  transients.ring_down_frequency_Hz = transients.ring_down_damping_ratio = unknown("no free ring-down was found");
  if (ramp) {
    transients.loading_stiffness_N_per_m = loading_stiffness(*detected.whole, trace, *ramp);
    transients.breakaway_force = symmetric(peak_force(*detected.whole, trace, *ramp), trace.noise, kManyFreedoms);
  }
  if (const auto ring = ring_down_of(detected, motion, ramp)) {
    transients.ring_down_frequency_Hz = ring->frequency_Hz;
    transients.ring_down_damping_ratio = ring->damping_ratio;
  }
  return transients;
}

}  // namespace slipfit
