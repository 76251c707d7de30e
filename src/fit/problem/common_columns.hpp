#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

/// Columns of what the cycles of a problem have in common: globals, exponent, then levels, differences and drifts
/// of the recordings, those that there are; shared ones once.
class CommonColumns {
 public:
  explicit CommonColumns(const Problem& problem);

  [[nodiscard]] Eigen::Index size() const { return size_; }
  /// Where k goes with the speed.
  [[nodiscard]] std::optional<Eigen::Index> exponent() const { return exponent_; }
  [[nodiscard]] Eigen::Index level(std::size_t recording) const { return levels_[recording]; }
  [[nodiscard]] Eigen::Index difference(std::size_t recording) const { return differences_[recording]; }
  [[nodiscard]] Eigen::Index drift(std::size_t recording) const { return drifts_[recording]; }
  /// Of the Jacobian of a recording's cycles, in its order.
  [[nodiscard]] const std::vector<Eigen::Index>& of(std::size_t recording) const { return of_[recording]; }
  /// Of the row of a steady recording: globals and the level that all share.
  [[nodiscard]] std::vector<Eigen::Index> of_steady(std::size_t globals) const;

 private:
  Eigen::Index size_ = 0;
  std::optional<Eigen::Index> exponent_;
  std::vector<Eigen::Index> levels_, differences_, drifts_;
  std::vector<std::vector<Eigen::Index>> of_;
};

/// Only the globals that the law has can be held.
Held held_in(const Problem& problem, Held held);

}  // namespace slipfit::fit
