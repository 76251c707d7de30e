#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fit/cycle/cycle_model.hpp"
#include "fit/problem/reduced_rows.hpp"

namespace slipfit::fit {

/// Room for a cycle's residuals and their Jacobian, which one cycle after the other uses: it stays in the cache.
struct CycleRows {
  std::vector<double> residuals;
  std::vector<double> jacobian;
};

/// A cycle in a Ceres problem. Parameter blocks: globals, [exponent,] [difference,] [constant,] [drift,] own. Its rows
/// are reduced to one a parameter and one more. Ceres asks one cost after the other; `prepare` may be called for
/// several cycles at a time before.
class CycleCost : public ceres::CostFunction {
 public:
  /// `room`: for what Ceres asks unprepared; shared by costs that no two threads evaluate. It and the model must
  /// outlive this.
  CycleCost(const CycleModel& model, CycleRows& room);

  /// Before they are reduced.
  [[nodiscard]] std::size_t rows() const { return model_.residuals(); }

  /// Works out what Evaluate will be asked at this point: residuals and, `with_jacobian`, their derivatives.
  void prepare(const double* const* parameters, bool with_jacobian, CycleRows& room);
  /// Forgets what is prepared: the parameters change.
  void forget() { prepared_ = Prepared::Nothing; }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override;
  /// The slip had no solution where it was evaluated last.
  [[nodiscard]] bool was_outside_model() const { return was_outside_model_; }

 private:
  enum class Prepared { Nothing, OutsideModel, Norm, Rows };

  /// Norm or Rows, or OutsideModel.
  Prepared work_out(const double* const* parameters, bool with_jacobian, CycleRows& room) const;
  bool evaluate(const double* const* parameters, bool with_jacobian, CycleRows& room) const;
  void put(bool with_jacobian, double* residuals, double** jacobians) const;

  const CycleModel& model_;
  CycleRows& room_;
  Prepared prepared_ = Prepared::Nothing;
  mutable std::vector<double> point_;  ///< at which the norm and the reduced rows are, where the slip is integrated
  mutable bool was_outside_model_ = false;
  mutable double norm_ = 0.0;
  mutable RowMajor reduced_;
};

}  // namespace slipfit::fit
