#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fit/problem/ramp_residual.hpp"

namespace slipfit::fit {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Normal equations of least squares from which the cycles' own parameters are eliminated, one cycle after the other: a
/// block Cholesky decomposition. Own parameters of a cycle meet the common ones and, where a ramp joins them, those of
/// the next cycle. The products square the condition number, as any normal equations do.
class Elimination {
 public:
  /// `common`: number of parameters that cycles have in common. `damping`: of steps of the own parameters, as in a step
  /// of Levenberg and Marquardt: a share by which the diagonal of their normal matrix grows.
  Elimination(Eigen::Index common, double damping);

  /// The next cycle. `normal`: [J r]' [J r] with the columns of its common parameters first, then its own, then the
  /// residuals r; the upper triangle is read. `columns`: of its common parameters among all; it must outlive this.
  /// `ramp`: to the cycle after it, which must have the same columns and as many own parameters, or null.
  void add_cycle(const RowMajor& normal, const std::vector<Eigen::Index>& columns, const RampResidual* ramp);
  /// Rows without own parameters.
  void add_common(const RowMajor& normal, const std::vector<Eigen::Index>& columns);

  /// Sum of squares by which full steps of all own parameters, the common ones as they are, make the sum smaller.
  [[nodiscard]] double own_gain() const { return own_gain_; }
  /// [J r]' [J r] of the common parameters, after such steps; the upper triangle.
  [[nodiscard]] const RowMajor& common() const { return common_; }
  /// Diagonal of J' J of the common parameters before them.
  [[nodiscard]] const Eigen::VectorXd& common_squares() const { return common_squares_; }

  /// Own parameters of every cycle, one cycle after the other, that go with a step of the common ones: their step to
  /// where the sum of squares is least, of which they take a `share` where the common ones stand still.
  [[nodiscard]] std::vector<double> own_steps(const Eigen::VectorXd& common_step, double share) const;

 private:
  /// Rows of the Cholesky factor: own, those of the next cycle, common, residual.
  struct Rows {
    std::size_t begin;  ///< in rows_
    Eigen::Index own;
    Eigen::Index next;  ///< number of the next cycle's parameters: 0 where no ramp joins them
    const std::vector<Eigen::Index>* columns;
  };

  void keep(Eigen::Index own, Eigen::Index next, const std::vector<Eigen::Index>& columns);
  void add_scattered(const RowMajor& normal, Eigen::Index first, const std::vector<Eigen::Index>& columns);
  void add_squares(const RowMajor& normal, Eigen::Index first, const std::vector<Eigen::Index>& columns);

  double damping_;
  RowMajor common_;
  Eigen::VectorXd common_squares_;
  RowMajor pending_;  ///< what the ramp from the cycle before adds to this one's rows: own, common, residual
  RowMajor work_;
  double own_gain_ = 0.0;
  std::vector<double> rows_;
  std::vector<Rows> cycles_;
};

/// Replaces the first rows of the upper triangle of a normal matrix by those of its Cholesky factor R, and the rest by
/// what remains of it without these parameters. `whole`: their diagonal before any other parameter was eliminated. A
/// parameter without influence of its own, whose pivot is nothing but rounding of it, leaves a row of zeros.
void factorise(RowMajor& normal, const Eigen::VectorXd& whole);

}  // namespace slipfit::fit
