#include "slipfit/signal/cycles.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "signal/mains_removal.hpp"
#include "signal/mask.hpp"
#include "signal/robust.hpp"
#include "signal/zigzag.hpp"

namespace slipfit {
namespace {

using signal::Fall;
using signal::Zigzag;

/// Median of three neighbours, impulses held at the last good value before.
std::vector<double> smooth(std::span<const double> force, const std::vector<bool>& impulses) {
  std::vector<double> smoothed(force.begin(), force.end());
  signal::for_each_set(impulses, [&](std::size_t i) {
    if (i > 0) smoothed[i] = smoothed[i - 1];
  });
  double before = smoothed.empty() ? 0.0 : smoothed.front();
  for (std::size_t i = 1; i + 1 < smoothed.size(); ++i) {
    const double here = smoothed[i];
    smoothed[i] = std::clamp(here, std::min(before, smoothed[i + 1]), std::max(before, smoothed[i + 1]));
    before = here;
  }
  return smoothed;
}

std::vector<double> drops_of(const std::vector<Fall>& falls, const std::vector<double>& force) {
  std::vector<double> drops;
  drops.reserve(falls.size());
  for (const Fall& fall : falls) drops.push_back(force[fall.peak] - force[fall.trough]);
  return drops;
}

/// The drop at which the sorted drops reach half of their sum: the size that carries the motion, however many small
/// falls there are beside.
double carrying_drop(std::vector<double> drops) {
  std::sort(drops.begin(), drops.end());
  const double half = 0.5 * std::accumulate(drops.begin(), drops.end(), 0.0);
  double sum = 0.0;
  for (const double drop : drops) {
    sum += drop;
    if (sum >= half) return drop;
  }
  return drops.empty() ? 0.0 : drops.back();
}

/// Of the values without the 0.5 % at either end; some of them are enough.
double central_range(const std::vector<double>& force) {
  std::vector<double> values;
  const std::size_t stride = signal::stride_for(force.size());
  values.reserve(force.size() / stride + 1);
  for (std::size_t i = 0; i < force.size(); i += stride) values.push_back(force[i]);
  const auto at = [&](double share) {
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
  };
  const double low = at(0.005);
  return at(0.995) - low;
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
  DetectedSlip slip{fall.peak, fall.trough, force[fall.peak], force[fall.trough], 0.0, 0.0};
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

}  // namespace

namespace {

/// The falls of one trace at several thresholds, none below `smallest`: only the first look goes over all samples.
class Falls {
 public:
  Falls(const std::vector<double>& force, double smallest) : force_(force) {
    Zigzag zigzag(smallest);
    for (std::size_t i = 0; i < force.size(); ++i) zigzag.add(i, force[i]);
    turns_ = zigzag.turns();
  }

  [[nodiscard]] std::vector<Fall> beyond(double hysteresis) const {
    Zigzag zigzag(hysteresis);
    for (const std::size_t i : turns_) zigzag.add(i, force_[i]);
    return zigzag.falls();
  }

 private:
  const std::vector<double>& force_;
  std::vector<std::size_t> turns_;
};

Segmentation find_slips_in(std::span<const double> raw, const Recording& recording, const Quality& quality) {
  const std::vector<double> force = smooth(raw, quality.impulse_mask);
  const double range = central_range(force);
  if (!(range > 0.0)) return {};
  // Noise makes no turning point below 10 standard deviations; beyond 0.35 of the range nothing would be left to find.
  const double noise_floor = std::min(10.0 * quality.noise_rms, 0.35 * range);
  const Falls all(force, noise_floor);
  double hysteresis = std::max(0.05 * range, noise_floor);
  for (int pass = 0; pass < 4; ++pass) {
    const double next = std::max(noise_floor, 0.4 * carrying_drop(drops_of(all.beyond(hysteresis), force)));
    const bool settled = std::abs(next - hysteresis) <= 1e-3 * hysteresis;
    hysteresis = next;
    if (settled || !(hysteresis > 0.0)) break;
  }
  if (!(hysteresis > 0.0)) return {};

  const double typical = signal::median(drops_of(all.beyond(hysteresis), force));
  Segmentation segmentation;
  segmentation.hysteresis = std::max(noise_floor, 0.25 * typical);
  const std::vector<Fall> falls = all.beyond(segmentation.hysteresis);
  const double quarter = 0.25 * signal::median(drops_of(falls, force));
  for (const Fall& fall : falls) {
    if (force[fall.peak] - force[fall.trough] < quarter) continue;
    segmentation.slips.push_back(describe(fall, recording.time_s(), force));
  }
  const double smallest = std::max(noise_floor, 0.1 * typical);
  segmentation.minor = all.beyond(smallest).size();
  segmentation.minor -= std::min(segmentation.minor, segmentation.slips.size());
  return segmentation;
}

}  // namespace

Segmentation find_slips(const Recording& recording, const Quality& quality) {
  return find_slips_in(recording.force(), recording, quality);
}

std::optional<Segmentation> find_slips_beneath_hum(const Recording& recording, const Quality& quality,
                                                   const Segmentation& seen) {
  const signal::Dehummed clean = signal::without_mains(recording);
  if (clean.lines_Hz.empty()) return std::nullopt;
  std::vector<double> drops;
  for (const DetectedSlip& slip : seen.slips) drops.push_back(slip.drop());
  if (clean.swing < kHarmlessHum * signal::median(drops)) return std::nullopt;
  Segmentation beneath = find_slips_in(clean.force, recording, quality);
  if (beneath.slips.empty()) return std::nullopt;
  beneath.mains_Hz = clean.lines_Hz;
  return beneath;
}

}  // namespace slipfit
