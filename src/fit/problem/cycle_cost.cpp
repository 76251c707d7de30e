#include "fit/problem/cycle_cost.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace slipfit::fit {

CycleCost::CycleCost(const CycleModel& model, CycleRows& room)
    : model_(model), room_(room), reduced_(model.columns() + 1, model.columns() + 1) {
  set_num_residuals(static_cast<int>(model.columns() + 1));
  for (const std::size_t size :
       {model.globals(), std::size_t{model.has_exponent() ? 1U : 0U}, std::size_t{model.has_difference() ? 1U : 0U},
        std::size_t{model.has_constant() ? 1U : 0U}, model.drift_parameters(), model.local_parameters()}) {
    if (size > 0) mutable_parameter_block_sizes()->push_back(static_cast<int>(size));
  }
}

void CycleCost::prepare(const double* const* parameters, bool with_jacobian, CycleRows& room) {
  if (prepared_ == Prepared::Nothing || (with_jacobian && prepared_ == Prepared::Norm)) {
    prepared_ = work_out(parameters, with_jacobian, room);
  }
}

bool CycleCost::Evaluate(const double* const* parameters, double* residuals, double** jacobians) const {
  const bool with_jacobian = jacobians != nullptr;
  const bool is_prepared = prepared_ == Prepared::OutsideModel || prepared_ == Prepared::Rows ||
                           (prepared_ == Prepared::Norm && !with_jacobian);
  const Prepared found = is_prepared ? prepared_ : work_out(parameters, with_jacobian, room_);
  was_outside_model_ = found == Prepared::OutsideModel;
  if (was_outside_model_) return false;
  put(with_jacobian, residuals, jacobians);
  return true;
}

/// Integrating a slip takes as long with its derivatives: they are kept for the step that follows from here.
CycleCost::Prepared CycleCost::work_out(const double* const* parameters, bool with_jacobian, CycleRows& room) const {
  if (!model_.is_integrated()) {
    if (!evaluate(parameters, with_jacobian, room)) return Prepared::OutsideModel;
    return with_jacobian ? Prepared::Rows : Prepared::Norm;
  }
  std::vector<double> point;
  for (std::size_t i = 0; i < parameter_block_sizes().size(); ++i) {
    point.insert(point.end(), parameters[i], parameters[i] + parameter_block_sizes()[i]);
  }
  if (point == point_) return Prepared::Rows;
  point_.clear();
  if (!evaluate(parameters, true, room)) return Prepared::OutsideModel;
  point_ = std::move(point);
  return Prepared::Rows;
}

bool CycleCost::evaluate(const double* const* parameters, bool with_jacobian, CycleRows& room) const {
  const auto next_if = [&](bool present) { return present ? *parameters++ : nullptr; };
  CycleValues values;
  values.globals = next_if(true);
  values.exponent = next_if(model_.has_exponent());
  values.difference = next_if(model_.has_difference());
  values.constant = next_if(model_.has_constant());
  values.drift = next_if(model_.drift_parameters() > 0);
  values.local = next_if(true);
  const std::size_t rows = model_.residuals();
  room.residuals.resize(std::max(room.residuals.size(), rows));
  if (with_jacobian) room.jacobian.resize(std::max(room.jacobian.size(), rows * model_.columns()));
  if (!model_.evaluate(values, room.residuals.data(), with_jacobian ? room.jacobian.data() : nullptr)) return false;
  const Eigen::Map<const Eigen::VectorXd> residuals(room.residuals.data(), static_cast<Eigen::Index>(rows));
  norm_ = residuals.norm();
  if (!with_jacobian) return true;
  const Eigen::Map<const Eigen::MatrixXd> jacobian(room.jacobian.data(), residuals.size(),
                                                   static_cast<Eigen::Index>(model_.columns()));
  reduce_rows(jacobian, residuals, reduced_);
  return true;
}

void CycleCost::put(bool with_jacobian, double* residuals, double** jacobians) const {
  if (!with_jacobian) {
    std::fill_n(residuals, num_residuals(), 0.0);
    residuals[0] = norm_;
    return;
  }
  Eigen::Map<Eigen::VectorXd>(residuals, reduced_.rows()) = reduced_.rightCols<1>();
  Eigen::Index column = 0;
  for (const int size : parameter_block_sizes()) {
    if (*jacobians != nullptr)
      Eigen::Map<RowMajor>(*jacobians, reduced_.rows(), size) = reduced_.middleCols(column, size);
    column += size;
    ++jacobians;
  }
}

}  // namespace slipfit::fit
