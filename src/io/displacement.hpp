#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace slipfit::reading {

struct Position {
  double time_s = 0.0;
  double displacement_m = 0.0;
};

/// A thinned record of a displacement column: every n-th position, n doubling so that it stays small.
class DisplacementTrack {
 public:
  void add(const Position& position);
  [[nodiscard]] const std::vector<Position>& positions() const { return positions_; }

 private:
  std::vector<Position> positions_;
  std::size_t stride_ = 1;
  std::size_t seen_ = 0;
};

/// The speed of the parts where it moves (median of block slopes, without sign), if most of them move at one speed.
std::optional<double> steady_speed_m_per_s(const DisplacementTrack& track);

}  // namespace slipfit::reading
