#include "fit/selection/clipping.hpp"

#include <algorithm>
#include <iterator>
#include <span>

#include "signal/mask.hpp"

namespace slipfit::fit {

std::vector<std::size_t> united(const std::vector<std::size_t>& first, const std::vector<std::size_t>& second) {
  std::vector<std::size_t> all;
  all.reserve(first.size() + second.size());
  std::set_union(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(all));
  return all;
}

std::vector<std::size_t> initial_exclusions(const Recording& recording, const Quality& quality) {
  std::vector<std::size_t> impulses;
  signal::for_each_set(quality.impulse_mask, [&](std::size_t i) { impulses.push_back(i); });
  if (!quality.clip_high && !quality.clip_low) return impulses;
  std::vector<std::size_t> clipped;
  const std::span<const double> force = recording.force();
  for (std::size_t i = 0; i < force.size(); ++i) {
    const bool high = quality.clip_high && force[i] >= *quality.clip_high;
    const bool low = quality.clip_low && force[i] <= *quality.clip_low;
    if (high || low) clipped.push_back(i);
  }
  return united(impulses, clipped);
}

std::vector<std::size_t> beyond_clip(const Recording& recording, const Quality& quality, const Residuals& residuals,
                                     double noise) {
  constexpr double kReach = 3.0;  // of the noise
  std::vector<std::size_t> beyond;
  if (!quality.clip_high && !quality.clip_low) return beyond;
  for (std::size_t i = 0; i < recording.size(); ++i) {
    if (residuals.part[i] == CyclePart::None) continue;
    const double model = recording.force()[i] - residuals.value[i];
    const bool above = quality.clip_high && model > *quality.clip_high - kReach * noise;
    const bool below = quality.clip_low && model < *quality.clip_low + kReach * noise;
    if (above || below) beyond.push_back(i);
  }
  return beyond;
}

}  // namespace slipfit::fit
