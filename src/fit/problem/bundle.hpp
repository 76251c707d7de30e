#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "fit/problem/block_fit.hpp"
#include "fit/problem/common_columns.hpp"
#include "fit/problem/elimination.hpp"
#include "fit/problem/solve_options.hpp"

namespace slipfit::fit {

/// The sum of squares of a problem as a function of the parameters that its cycles have in common: each cycle's own
/// follow them (variable projection, one Gauss-Newton step at a time).
class Bundle {
 public:
  /// Both must outlive this.
  Bundle(const Problem& problem, const SolveOptions& options);

  struct Values {
    Eigen::VectorXd common;  ///< in the order of CommonColumns
    std::vector<Local> cycles;
  };
  struct Point : Values {
    double sum = 0.0;  ///< of squares; where SolveOptions::robust, cycles far worse than the others counted linearly
    Elimination normal;
  };
  /// Returns the point at the parameters of the recordings; it is empty outside the model. `damping` applies to the
  /// steps of the cycles' own parameters from there (Elimination).
  [[nodiscard]] std::optional<Point> start(double damping) const;
  /// Does the same as `start` at other values.
  [[nodiscard]] std::optional<Point> at(Values values, double damping) const;
  /// Returns the values after a step of the common parameters. The cycles' own follow, and they take `share` of the
  /// step by which they can still gain where the common ones are fixed.
  [[nodiscard]] Values moved(const Point& from, const Eigen::VectorXd& step, double share) const;
  /// Returns whether the slips of all cycles have solutions there. Where slips are integrated this is not checked, and
  /// so false: it would take as long as the sum of squares.
  [[nodiscard]] bool is_inside(const Values& values) const;
  /// Writes values to the recordings, which have the problem's order.
  void put(const Values& values, std::span<BlockFit> recordings) const;

  [[nodiscard]] Eigen::Index common() const { return columns_.size(); }
  /// Rows of residuals.
  [[nodiscard]] std::size_t residuals() const { return residuals_; }

 private:
  [[nodiscard]] bool add(std::size_t recording, std::size_t first_cycle, Point& point) const;
  /// Writes [J r]' [J r] of a cycle with [J r] = `lines`, as Elimination takes it, and returns the cycle's part of the
  /// sum.
  [[nodiscard]] double put_products(const Eigen::MatrixXd& lines, Eigen::Ref<RowMajor> normal) const;
  [[nodiscard]] bool add_steady(Point& point) const;

  const Problem& problem_;
  const SolveOptions& options_;
  CommonColumns columns_;
  std::size_t residuals_ = 0;
};

}  // namespace slipfit::fit
