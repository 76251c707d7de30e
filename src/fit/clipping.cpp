#include "fit/clipping.hpp"

#include <algorithm>
#include <span>

namespace slipfit::fit {

std::vector<std::size_t> initial_exclusions(const Recording& recording, const Quality& quality) {
  std::vector<std::size_t> excluded;
  const std::vector<bool>& impulses = quality.impulse_mask;
  for (auto it = impulses.begin(); (it = std::find(it, impulses.end(), true)) != impulses.end(); ++it) {
    excluded.push_back(static_cast<std::size_t>(it - impulses.begin()));
  }
  if (!quality.clip_high && !quality.clip_low) return excluded;
  const std::span<const double> force = recording.force();
  for (std::size_t i = 0; i < force.size(); ++i) {
    const bool high = quality.clip_high && force[i] >= *quality.clip_high;
    const bool low = quality.clip_low && force[i] <= *quality.clip_low;
    if (high || low) excluded.push_back(i);
  }
  std::sort(excluded.begin(), excluded.end());
  excluded.erase(std::unique(excluded.begin(), excluded.end()), excluded.end());
  return excluded;
}

std::vector<std::size_t> beyond_clip(const Recording& recording, const Quality& quality, const Residuals& residuals,
                                     double noise) {
  constexpr double kReach = 3.0;  // of the noise
  std::vector<std::size_t> beyond;
  if (!quality.clip_high && !quality.clip_low) return beyond;
  for (std::size_t i = 0; i < recording.size(); ++i) {
    if (residuals.phase[i] == Phase::None) continue;
    const double model = recording.force()[i] - residuals.value[i];
    const bool above = quality.clip_high && model > *quality.clip_high - kReach * noise;
    const bool below = quality.clip_low && model < *quality.clip_low + kReach * noise;
    if (above || below) beyond.push_back(i);
  }
  return beyond;
}

}  // namespace slipfit::fit
