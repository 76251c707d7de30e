#include "fit/clipping.hpp"

namespace slipfit::fit {

std::vector<bool> initial_exclusions(const Recording& recording, const Quality& quality) {
  std::vector<bool> excluded = quality.impulse_mask;
  if (!quality.clip_high && !quality.clip_low) return excluded;
  excluded.resize(recording.size(), false);
  for (std::size_t i = 0; i < recording.size(); ++i) {
    const double force = recording.force()[i];
    if ((quality.clip_high && force >= *quality.clip_high) || (quality.clip_low && force <= *quality.clip_low)) {
      excluded[i] = true;
    }
  }
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
