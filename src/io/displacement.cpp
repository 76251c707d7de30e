#include "io/displacement.hpp"

#include <algorithm>
#include <cmath>

#include "core/quantile.hpp"

namespace slipfit::reading {
namespace {

constexpr std::size_t kMostPositions = 4096;
constexpr std::size_t kBlocks = 64;

}  // namespace

void DisplacementTrack::add(const Position& position) {
  if (seen_++ % stride_ != 0) return;
  if (positions_.size() == kMostPositions) {
    for (std::size_t i = 0; 2 * i < positions_.size(); ++i) positions_[i] = positions_[2 * i];
    positions_.resize(kMostPositions / 2);
    stride_ *= 2;
    if ((seen_ - 1) % stride_ != 0) return;
  }
  positions_.push_back(position);
}

std::optional<double> steady_speed_m_per_s(const DisplacementTrack& track) {
  const auto& positions = track.positions();
  const std::size_t step = std::max<std::size_t>(1, positions.size() / kBlocks);
  std::vector<double> speeds;
  for (std::size_t i = step; i < positions.size(); i += step) {
    const double duration_s = positions[i].time_s - positions[i - step].time_s;
    if (duration_s <= 0.0) continue;
    speeds.push_back(std::abs(positions[i].displacement_m - positions[i - step].displacement_m) / duration_s);
  }
  if (speeds.size() < 4) return std::nullopt;
  const double fast_m_per_s = quantile_of(speeds, 0.9);
  std::erase_if(speeds, [&](double v) { return !(v > 0.2 * fast_m_per_s); });  // standing, or about to start
  if (speeds.size() < 3) return std::nullopt;
  const double speed_m_per_s = quantile_of(speeds, 0.5);
  const auto alike = std::count_if(speeds.begin(), speeds.end(),
                                   [&](double v) { return std::abs(v - speed_m_per_s) <= 0.2 * speed_m_per_s; });
  const bool is_steady = 10 * alike >= 6 * static_cast<std::ptrdiff_t>(speeds.size());
  return is_steady ? std::optional(speed_m_per_s) : std::nullopt;
}

}  // namespace slipfit::reading
