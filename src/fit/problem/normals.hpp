#pragma once

#include <Eigen/Core>
#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "fit/cycle/cycle_model.hpp"
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

/// The ramp from the end of one slip to the onset of the next is one line: residual (kV (t2 - t1) + u I - A2) and its
/// derivatives with respect to ln k, ln w_n and zeta, first own (2), second own (2), scaled by Scales::noise *
/// kRampTolerance. Coulomb friction.
struct RampResidual {
  double value = 0.0;
  std::array<double, 3> d_values{};
  std::array<double, 2> d_first{};
  std::array<double, 2> d_second{};
};
RampResidual ramp_residual(const BlockFit& fit, std::size_t first, const Coordinates& values, const double* local_first,
                           const double* local_second);

/// The tolerance counts in units of the noise. It is small enough to hold the ramp together (a ramp's mean is known to
/// noise / sqrt(samples)) and large enough to keep the normal equations well conditioned.
inline constexpr double kRampTolerance = 0.01;

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

/// [J r] of a cycle at some parameters: the derivatives of its residuals with respect to the parameters that it has in
/// common with others, those with respect to its own, and the residuals. False: outside the model.
bool evaluate_lines(const CycleModel& model, const CycleValues& values, Eigen::MatrixXd& lines);

/// [J r]' [J r] as Elimination takes it: the upper triangle; the rest is not set.
RowMajor products_of(const Eigen::Ref<const Eigen::MatrixXd>& lines);
void products_of(const Eigen::Ref<const Eigen::MatrixXd>& lines, Eigen::Ref<RowMajor> products);
/// Returns the products of a steady recording: the coordinates of `columns`, the level that all recordings share, the
/// residual.
RowMajor products_of(const SteadyResidual& steady, const Columns& columns);

/// One cycle's (or steady recording's, without own parameters) part of the normal equations at a solution.
struct Normal {
  std::vector<Eigen::Index> columns;  ///< of its common parameters among the problem's
  RowMajor products;                  ///< as Elimination takes it
  Eigen::VectorXd residuals;          ///< of a cycle; the samples around the slip come first

  [[nodiscard]] Eigen::Index common() const { return static_cast<Eigen::Index>(columns.size()); }
  [[nodiscard]] Eigen::Index own() const { return products.cols() - common() - 1; }
};

std::vector<Normal> normals_of(const Problem& problem);

/// Those of the other recordings, numbered as their own problem has it. `all`: without one of its recordings it is
/// `others`.
std::vector<Normal> normals_without(const Problem& all, std::size_t recording, const std::vector<Normal>& normals,
                                    const Problem& others);

}  // namespace slipfit::fit
