#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

/// Columns of what the cycles of a problem have in common: coordinates, levels and drifts of the recordings, those that
/// there are; shared ones once.
class CommonColumns {
 public:
  explicit CommonColumns(const Problem& problem);

  [[nodiscard]] Eigen::Index size() const { return size_; }
  /// Returns the column of a coordinate that the fit of this recording solves for; it is empty where it does not.
  [[nodiscard]] std::optional<Eigen::Index> find(std::size_t recording, Coordinate coordinate) const {
    return coordinates_[recording][static_cast<std::size_t>(coordinate)];
  }
  /// Returns the column of the level's constant; `drift` returns that of the first of the level's other functions.
  [[nodiscard]] Eigen::Index level(std::size_t recording) const { return levels_[recording]; }
  [[nodiscard]] Eigen::Index drift(std::size_t recording) const { return drifts_[recording]; }
  /// Returns the column of each common parameter of a recording's cycles, in the order of their Jacobian.
  [[nodiscard]] const std::vector<Eigen::Index>& of(std::size_t recording) const { return of_[recording]; }
  /// Returns the columns of the row of a steady recording: the coordinates of the first recording and the level that
  /// all share.
  [[nodiscard]] const std::vector<Eigen::Index>& of_steady() const { return of_steady_; }
  /// Returns the columns of the coordinates that are fixed, in ascending order.
  [[nodiscard]] std::vector<Eigen::Index> held(const Held& held) const;
  /// Calls f(column, value) for each common parameter that a recording has. `parameters`: its own, or a copy.
  template <class P, class F>
  void visit(std::size_t recording, const BlockFit& fit, P& parameters, const F& f) const {
    auto column = of_[recording].begin();
    for (const Coordinate coordinate : fit.columns().coordinates()) f(*column++, parameters.values(coordinate));
    for (auto& value : parameters.level) f(*column++, value);
  }

 private:
  using OfCoordinates = std::array<std::optional<Eigen::Index>, kCoordinates>;

  Eigen::Index size_ = 0;
  std::vector<OfCoordinates> coordinates_;
  std::vector<Eigen::Index> levels_, drifts_;
  std::vector<std::vector<Eigen::Index>> of_;
  std::vector<Eigen::Index> of_steady_;
};

}  // namespace slipfit::fit
