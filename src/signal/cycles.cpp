#include "slipfit/signal/cycles.hpp"

#include <Eigen/Core>

#include "core/thresholds.hpp"
#include "signal/defects.hpp"
#include "signal/events.hpp"
#include "signal/mains.hpp"
#include "signal/smoothing.hpp"
#include "signal/stretch.hpp"

namespace slipfit {
namespace {

using signal::Fall;

/// Median of three neighbours, impulses held at the last good value before.
std::vector<double> smooth(std::span<const double> force, const std::vector<bool>& impulses) {
  std::vector<double> held;
  if (!impulses.empty()) {
    held.assign(force.begin(), force.end());
    signal::for_each_set(impulses, [&](std::size_t i) {
      if (i > 0) held[i] = held[i - 1];
    });
    force = held;
  }
  std::vector<double> smoothed(force.begin(), force.end());
  if (force.size() < 3) return smoothed;
  const auto inner = std::ssize(force) - 2;
  const auto shifted = [&](std::ptrdiff_t by) {
    return Eigen::Map<const Eigen::ArrayXd>(force.data() + 1 + by, inner);
  };
  Eigen::Map<Eigen::ArrayXd>(smoothed.data() + 1, inner) =
      shifted(0).max(shifted(-1).min(shifted(1))).min(shifted(-1).max(shifted(1)));
  return smoothed;
}

/// Last time before `from`, or first after it, at which the force is beyond `level`; linear between samples.
double crossing_before(std::span<const double> time_s, const std::vector<double>& force, std::size_t from,
                       std::size_t stop, double level) {
  for (std::size_t i = from; i > stop; --i) {
    if (force[i - 1] >= level && force[i] < level) {
      const double share = (force[i - 1] - level) / (force[i - 1] - force[i]);
      return time_s[i - 1] + share * (time_s[i] - time_s[i - 1]);
    }
  }
  return time_s[stop];
}

double crossing_after(std::span<const double> time_s, const std::vector<double>& force, std::size_t from,
                      std::size_t stop, double level) {
  for (std::size_t i = from; i < stop; ++i) {
    if (force[i] > level && force[i + 1] <= level) {
      const double share = (force[i] - level) / (force[i] - force[i + 1]);
      return time_s[i] + share * (time_s[i + 1] - time_s[i]);
    }
  }
  return time_s[stop];
}

DetectedSlip describe(const Fall& fall, std::span<const double> time_s, const std::vector<double>& force) {
  DetectedSlip slip{fall.peak, fall.trough, force[fall.peak], force[fall.trough], 0.0, 0.0, 0.0};
  const auto level = [&](double share) { return slip.trough_force + share * slip.drop(); };
  // The fastest part of the fall: the last sample above the middle before the force is first below it for good.
  std::size_t middle = fall.trough;
  while (middle > fall.peak && force[middle - 1] < level(0.5)) --middle;
  slip.middle_s = crossing_before(time_s, force, middle, fall.peak, level(0.5));
  const double above_s = crossing_before(time_s, force, middle, fall.peak, level(0.8));
  const double below_s =
      crossing_after(time_s, force, middle > fall.peak ? middle - 1 : middle, fall.trough, level(0.2));
  slip.fall_s = below_s - above_s;
  return slip;
}

/// Time of the quickest rise from 20 % to 80 % between a trough and the peak after it.
double rise_time_s(std::span<const double> time_s, const std::vector<double>& force, std::size_t trough,
                   std::size_t peak) {
  const double rise = force[peak] - force[trough];
  const double low = force[trough] + 0.2 * rise;
  const double high = force[trough] + 0.8 * rise;
  const auto crossing_s = [&](std::size_t i, double level) {
    return time_s[i] + (level - force[i]) / (force[i + 1] - force[i]) * (time_s[i + 1] - time_s[i]);
  };
  double low_s = time_s[trough];
  for (std::size_t i = trough; i < peak; ++i) {
    if (force[i] <= low && force[i + 1] > low) low_s = crossing_s(i, low);
    if (force[i] < high && force[i + 1] >= high) return crossing_s(i, high) - low_s;
  }
  return time_s[peak] - low_s;
}

/// Leaves out falls from the end of one stroke to the start of the next.
void remove_falls_between_strokes(std::vector<Fall>& falls, const Recording& recording) {
  if (recording.provenance().strokes == 0) return;
  std::erase_if(falls, [&](const Fall& fall) { return signal::has_gap(recording, fall.peak, fall.trough); });
}

Segmentation find_slips_in(std::span<const double> raw, const Recording& recording, const Quality& quality,
                           std::optional<std::size_t> scale) {
  signal::Events events = signal::find_events(smooth(raw, quality.impulse_mask), quality.noise_rms, scale);
  remove_falls_between_strokes(events.falls, recording);
  Segmentation segmentation;
  segmentation.hysteresis = events.hysteresis;
  segmentation.minor = events.minor;
  segmentation.noise = events.noise;
  segmentation.smoothed_over = events.width;
  for (const Fall& fall : events.falls) {
    std::vector<DetectedSlip>& slips = segmentation.slips;
    if (!slips.empty()) {
      slips.back().rise_s = rise_time_s(recording.time_s(), events.trace, slips.back().trough, fall.peak);
    }
    slips.push_back(describe(fall, recording.time_s(), events.trace));
  }
  const SampleRange sliding = signal::sliding_stretch(events.trace, events.falls);
  segmentation.sliding_begin = sliding.begin;
  segmentation.sliding_end = sliding.end;
  return segmentation;
}

}  // namespace

Segmentation find_slips(const Recording& recording, const Quality& quality, std::optional<std::size_t> scale) {
  return find_slips_in(recording.force(), recording, quality, scale);
}

std::optional<Segmentation> find_slips_beneath_hum(const Recording& recording, const Quality& quality,
                                                   const Segmentation& seen) {
  const signal::Dehummed clean = signal::without_mains(recording);
  if (clean.lines_Hz.empty()) return std::nullopt;
  std::vector<double> drops;
  for (const DetectedSlip& slip : seen.slips) drops.push_back(slip.drop());
  if (clean.swing < kHarmlessHum * signal::median(drops)) return std::nullopt;
  Segmentation beneath = find_slips_in(clean.force, recording, quality, std::nullopt);
  if (beneath.slips.empty()) return std::nullopt;
  beneath.mains_Hz = clean.lines_Hz;
  return beneath;
}

}  // namespace slipfit
