#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "fit/cycle/cycle_model.hpp"
#include "fit/problem/elimination.hpp"
#include "fit/problem/steady_run.hpp"

namespace slipfit::fit {

/// [J r] of a cycle at some parameters: the derivatives of its residuals with respect to the parameters that it has in
/// common with others, those with respect to its own, and the residuals. False: outside the model.
bool evaluate_lines(const CycleModel& model, const CycleValues& values, Eigen::MatrixXd& lines);

/// [J r]' [J r] as Elimination takes it: the upper triangle; the rest is not set.
RowMajor products_of(const Eigen::Ref<const Eigen::MatrixXd>& lines);
void products_of(const Eigen::Ref<const Eigen::MatrixXd>& lines, Eigen::Ref<RowMajor> products);
/// Returns the products of a steady recording: the coordinates of `columns`, the level that all recordings share, the
/// residual.
RowMajor products_of(const SteadyResidual& steady, const Columns& columns);

}  // namespace slipfit::fit
