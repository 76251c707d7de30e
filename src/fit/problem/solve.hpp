#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "fit/coordinates.hpp"
#include "fit/problem/block_fit.hpp"
#include "fit/problem/normals.hpp"

namespace slipfit::fit {

struct SolveOptions {
  Held held{};
  bool continuous = false;  ///< neighbouring cycles share their ramp (strong coupling, see kRampTolerance)
  bool robust = false;      ///< a cycle far worse than the others counts linearly, not squared
  int max_iterations = 60;
  /// Ends with the step that gains less than this much of one residual's share of the cost: 1e-3 leaves the parameters
  /// within a thousandth of a standard error (99 of 100 within 0.006), 0.1 is enough for a start.
  double tolerance = 1e-3;
  bool damped = false;  ///< zeta stays at 0 or above, in a search that a negative one would lead astray
};

/// Holds the weight of a cycle that is far worse than the others (SolveOptions::robust).
struct HuberWeight {
  double factor = 1.0;  ///< of its squares in the normal equations
  double sum = 0.0;     ///< that replaces its sum of squares
};

/// Returns the weight of a cycle. `norm` is the root of the sum of squares of its `residuals` residuals; above a bound
/// it counts linearly.
inline HuberWeight huber_weight(double norm, std::size_t residuals) {
  const double bound = 3.0 * std::sqrt(static_cast<double>(residuals));
  if (!(norm > bound)) return {1.0, norm * norm};
  return {bound / norm, 2.0 * bound * norm - bound * bound};
}

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

/// Levenberg-Marquardt by Ceres from the recordings' parameters (what they share: the first one's); the cycles' own are
/// eliminated first (Elimination). A parameter that presses against an end of its range is held there while the others
/// go on, and let go where the sum falls inwards. Leaves the solution in all recordings. Returns the sum of squared
/// residuals, infinity where the start is outside the model.
double solve_together(std::span<BlockFit> recordings, const SweepTerms& sweep, const SolveOptions& options);
/// Solves for one recording by itself, as solve_together does.
double solve(BlockFit& fit, const SolveOptions& options);

}  // namespace slipfit::fit
