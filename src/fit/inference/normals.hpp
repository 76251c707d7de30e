#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <optional>
#include <vector>

#include "fit/coordinates.hpp"
#include "fit/problem/solve.hpp"

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

 private:
  Eigen::Index size_ = 0;
  std::optional<Eigen::Index> exponent_;
  std::vector<Eigen::Index> levels_, differences_, drifts_;
  std::vector<std::vector<Eigen::Index>> of_;
};

/// One cycle's residuals r and their derivatives J at the solution; the samples around the slip come first.
struct Linearised {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd common;
  Eigen::MatrixXd local;
};

/// One cycle's (or steady recording's, without own parameters) part of the normal equations.
struct Normal {
  std::vector<Eigen::Index> columns;  ///< of `common` among the problem's
  Eigen::MatrixXd common;             ///< common x common
  Eigen::MatrixXd cross;              ///< common x own
  Eigen::MatrixXd local;              ///< own x own
  Eigen::VectorXd score;              ///< J' r for common
  Eigen::VectorXd local_score;
  Eigen::VectorXd residuals;
};

Linearised linearise(const BlockFit& fit, std::size_t cycle);
std::vector<Normal> normals_of(const Problem& problem);

/// Those of the other recordings, numbered as their own problem has it. `all`: without one of its recordings it is
/// `others`.
std::vector<Normal> normals_without(const Problem& all, std::size_t recording, const std::vector<Normal>& normals,
                                    const Problem& others);

}  // namespace slipfit::fit
