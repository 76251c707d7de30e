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
  /// At the parameters of the recordings. `damping`: of the steps of the cycles' own from there (Elimination). Empty:
  /// outside the model.
  [[nodiscard]] std::optional<Point> start(double damping) const;
  /// As start, elsewhere.
  [[nodiscard]] std::optional<Point> at(Values values, double damping) const;
  /// After a step of the common parameters; the cycles' own follow, and take `share` of the step that they have to gain
  /// by where the common ones stand still.
  [[nodiscard]] Values moved(const Point& from, const Eigen::VectorXd& step, double share) const;
  /// Whether the slips of all cycles have solutions there. Not told, and so false, where they are integrated: that
  /// takes as long as the sum of squares.
  [[nodiscard]] bool is_inside(const Values& values) const;
  /// Writes values to the recordings, which have the problem's order.
  void put(const Values& values, std::span<BlockFit> recordings) const;

  [[nodiscard]] Eigen::Index common() const { return columns_.size(); }
  /// Rows of residuals.
  [[nodiscard]] std::size_t residuals() const { return residuals_; }

 private:
  [[nodiscard]] bool add(std::size_t recording, std::size_t first_cycle, Point& point) const;
  /// Of a cycle with [J r] = `lines`: [J r]' [J r] as Elimination takes it, and its part of the sum.
  [[nodiscard]] double put_products(const Eigen::MatrixXd& lines, Eigen::Ref<RowMajor> normal) const;
  [[nodiscard]] bool add_steady(Point& point) const;

  const Problem& problem_;
  const SolveOptions& options_;
  CommonColumns columns_;
  std::size_t residuals_ = 0;
};

}  // namespace slipfit::fit
