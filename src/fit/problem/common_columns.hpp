#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

/// Columns of what the cycles of a problem have in common: globals, exponent, time of the sensor, then levels,
/// differences and drifts of the recordings, those that there are; shared ones once.
class CommonColumns {
 public:
  explicit CommonColumns(const Problem& problem);

  [[nodiscard]] Eigen::Index size() const { return size_; }
  /// Where k goes with the speed.
  [[nodiscard]] std::optional<Eigen::Index> exponent() const { return exponent_; }
  /// Where it is free in a recording; all of them share it.
  [[nodiscard]] std::optional<Eigen::Index> sensor_time() const { return sensor_time_; }
  [[nodiscard]] Eigen::Index level(std::size_t recording) const { return levels_[recording]; }
  [[nodiscard]] Eigen::Index difference(std::size_t recording) const { return differences_[recording]; }
  [[nodiscard]] Eigen::Index drift(std::size_t recording) const { return drifts_[recording]; }
  /// Of the Jacobian of a recording's cycles, in its order.
  [[nodiscard]] const std::vector<Eigen::Index>& of(std::size_t recording) const { return of_[recording]; }
  /// Calls f(column, value) for each common parameter that a recording has, but for the time of the sensor.
  /// `parameters`: its own, or a copy.
  template <class P, class F>
  void visit(std::size_t recording, const BlockFit& fit, P& parameters, const F& f) const {
    const CycleModel& any = fit.model(0);
    for (std::size_t i = 0; i < any.globals(); ++i) f(static_cast<Eigen::Index>(i), parameters.globals[i]);
    if (exponent_) f(*exponent_, parameters.exponent);
    if (any.has_difference()) f(differences_[recording], parameters.difference);
    const std::size_t constants = any.has_constant() ? 1 : 0;
    if (constants > 0) f(levels_[recording], parameters.level.front());
    for (std::size_t i = 0; i < any.drift_parameters(); ++i) {
      f(drifts_[recording] + static_cast<Eigen::Index>(i), parameters.level[constants + i]);
    }
  }
  /// Of the row of a steady recording: globals and the level that all share.
  [[nodiscard]] std::vector<Eigen::Index> of_steady(std::size_t globals) const;

 private:
  Eigen::Index size_ = 0;
  std::optional<Eigen::Index> exponent_, sensor_time_;
  std::vector<Eigen::Index> levels_, differences_, drifts_;
  std::vector<std::vector<Eigen::Index>> of_;
};

/// Only the globals that the law has can be held.
Held held_in(const Problem& problem, Held held);

}  // namespace slipfit::fit
