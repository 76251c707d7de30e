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
  /// of Levenberg and Marquardt: a share by which the diagonal of their normal matrix grows. `sides`: number of columns
  /// r of residuals that are fitted side by side.
  explicit Elimination(Eigen::Index common, double damping = 0.0, Eigen::Index sides = 1);

  /// The next cycle. `normal`: [J r]' [J r] with the columns of its common parameters first, then its own, then the
  /// residuals r; the upper triangle is read. `columns`: of its common parameters among all; it must outlive this.
  /// `ramp`: to the cycle after it, which must have the same columns and as many own parameters, or null; its value is
  /// one of the first residuals. Rows without own parameters count as a cycle that has none.
  void add_cycle(const Eigen::Ref<const RowMajor>& normal, const std::vector<Eigen::Index>& columns,
                 const RampResidual* ramp = nullptr);

  /// Sum of squares by which full steps of all own parameters, the common ones as they are, make the sum smaller.
  [[nodiscard]] double own_gain() const { return own_gain_; }
  /// [J r]' [J r] of the common parameters, after such steps; the upper triangle.
  [[nodiscard]] const RowMajor& common() const { return common_; }
  /// The last cycle's part of it, in the order of its columns; the lower triangle means nothing.
  [[nodiscard]] RowMajor latest() const { return latest_part(); }
  /// Diagonal of J' J of the common parameters before them.
  [[nodiscard]] const Eigen::VectorXd& common_squares() const { return common_squares_; }
  /// Some own parameter has no influence that others do not have.
  [[nodiscard]] bool is_singular() const { return is_singular_; }

  /// Returns the steps of the own parameters of every cycle, one cycle after the other, for steps of the common ones.
  /// They lead to where the sums of squares are least; of the step that remains where the common ones are fixed, they
  /// take a `share`. The result has a column for each of `sides`.
  [[nodiscard]] RowMajor own_steps(const Eigen::MatrixXd& common_steps, double share) const;

 private:
  /// Rows of the Cholesky factor: own, those of the next cycle, common, residual.
  struct Rows {
    std::size_t begin;  ///< in rows_
    Eigen::Index own;
    Eigen::Index next;  ///< number of the next cycle's parameters: 0 where no ramp joins them
    const std::vector<Eigen::Index>* columns;
  };

  void keep(Eigen::Index own, Eigen::Index next, const std::vector<Eigen::Index>& columns);
  void add_squares(Eigen::Index first, const std::vector<Eigen::Index>& columns);
  [[nodiscard]] Eigen::Block<const RowMajor> latest_part() const {
    const Eigen::Index size = static_cast<Eigen::Index>(cycles_.back().columns->size()) + sides_;
    return work_.bottomRightCorner(size, size);
  }

  double damping_;
  Eigen::Index sides_;
  RowMajor common_;
  Eigen::VectorXd common_squares_;
  RowMajor pending_;  ///< what the ramp from the cycle before adds to this one's rows: own, common, residual
  RowMajor work_;
  double own_gain_ = 0.0;
  bool is_singular_ = false;
  std::vector<double> rows_;
  std::vector<Rows> cycles_;
};

/// Adds a part of [J r]' [J r] whose first columns are these of the sum, and whose last are its last. Upper triangles.
void add_scattered(const Eigen::Ref<const RowMajor>& part, const std::vector<Eigen::Index>& columns, RowMajor& sum);

/// Replaces the first rows of the upper triangle of a normal matrix by those of its Cholesky factor R, and the rest by
/// what remains of it without these parameters. `whole`: their diagonal before any other parameter was eliminated. A
/// parameter without influence of its own, whose pivot is nothing but rounding of it, leaves a row of zeros. Whether
/// every one has such influence.
bool factorise(RowMajor& normal, const Eigen::VectorXd& whole);

}  // namespace slipfit::fit
