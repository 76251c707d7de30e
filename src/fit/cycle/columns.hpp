#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "fit/coordinates.hpp"
#include "fit/cycle/cycle_data.hpp"
#include "fit/level/level_model.hpp"

namespace slipfit::fit {

/// The columns of the Jacobian of a recording's cycles: the coordinates that the fit solves for, in the order of
/// Coordinate, then the level's constant, where there is one, the level's other functions, and the cycle's own.
class Columns {
 public:
  Columns(const Scales& scales, const LevelModel& level);

  [[nodiscard]] const std::vector<Coordinate>& coordinates() const { return coordinates_; }
  /// Returns whether the fit solves for the coordinate.
  [[nodiscard]] bool has(Coordinate coordinate) const { return column_[index(coordinate)].has_value(); }
  [[nodiscard]] std::optional<std::size_t> find(Coordinate coordinate) const { return column_[index(coordinate)]; }
  [[nodiscard]] bool has_constant() const { return has_constant_; }
  /// Returns the number of the level's functions besides the constant.
  [[nodiscard]] std::size_t drift() const { return drift_; }
  [[nodiscard]] std::size_t own() const { return own_; }
  /// Returns the number of columns that cycles have in common; they come first.
  [[nodiscard]] std::size_t common() const { return first_drift() + drift_; }
  [[nodiscard]] std::size_t size() const { return common() + own_; }
  [[nodiscard]] std::size_t first_drift() const { return coordinates_.size() + (has_constant_ ? 1 : 0); }

 private:
  static std::size_t index(Coordinate coordinate) { return static_cast<std::size_t>(coordinate); }

  std::vector<Coordinate> coordinates_;
  std::array<std::optional<std::size_t>, kCoordinates> column_{};
  bool has_constant_ = false;
  std::size_t drift_ = 0;
  std::size_t own_ = 0;
};

}  // namespace slipfit::fit
