#pragma once

#include <ceres/cost_function.h>
#include <ceres/sized_cost_function.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "fit/problem/ramp_residual.hpp"
#include "fit/problem/reduced_rows.hpp"
#include "fit/problem/steady_run.hpp"

namespace slipfit::fit {

/// Parameter blocks: globals, [exponent,] [difference,] [constant,] [drift,] own. The cycle's rows are reduced to one a
/// parameter and one more, which must not be asked of two threads at a time.
class CycleCost : public ceres::CostFunction {
 public:
  explicit CycleCost(const CycleModel& model)
      : model_(model),
        residuals_(model.residuals()),
        jacobian_(model.residuals(), model.columns()),
        reduced_(model.columns() + 1, model.columns() + 1) {
    set_num_residuals(static_cast<int>(model.columns() + 1));
    for (const std::size_t size :
         {model.globals(), std::size_t{model.has_exponent() ? 1U : 0U}, std::size_t{model.has_difference() ? 1U : 0U},
          std::size_t{model.has_constant() ? 1U : 0U}, model.drift_parameters(), model.local_parameters()}) {
      if (size > 0) mutable_parameter_block_sizes()->push_back(static_cast<int>(size));
    }
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    if (!prepare(parameters, jacobians != nullptr)) return false;
    if (jacobians == nullptr) {
      std::fill_n(residuals, num_residuals(), 0.0);
      residuals[0] = residuals_.norm();
    } else {
      reduce_rows(jacobian_, residuals_, reduced_);
      put_reduced(residuals, jacobians);
    }
    return true;
  }

 private:
  /// Makes the residuals and, where it is asked for, the Jacobian those of this point. Integrating a slip takes as long
  /// with its derivatives: they are kept for the step that follows from here.
  bool prepare(const double* const* parameters, bool with_jacobian) const {
    if (!model_.is_integrated()) return evaluate(parameters, with_jacobian);
    std::vector<double> point;
    for (std::size_t i = 0; i < parameter_block_sizes().size(); ++i) {
      point.insert(point.end(), parameters[i], parameters[i] + parameter_block_sizes()[i]);
    }
    if (point == point_) return true;
    point_.clear();
    if (!evaluate(parameters, true)) return false;
    point_ = std::move(point);
    return true;
  }

  bool evaluate(const double* const* parameters, bool with_jacobian) const {
    const auto next_if = [&](bool present) { return present ? *parameters++ : nullptr; };
    CycleValues values;
    values.globals = next_if(true);
    values.exponent = next_if(model_.has_exponent());
    values.difference = next_if(model_.has_difference());
    values.constant = next_if(model_.has_constant());
    values.drift = next_if(model_.drift_parameters() > 0);
    values.local = next_if(true);
    return model_.evaluate(values, residuals_.data(), with_jacobian ? jacobian_.data() : nullptr);
  }

  void put_reduced(double* residuals, double** jacobians) const {
    Eigen::Map<Eigen::VectorXd>(residuals, reduced_.rows()) = reduced_.rightCols<1>();
    Eigen::Index column = 0;
    for (const int size : parameter_block_sizes()) {
      if (*jacobians != nullptr)
        Eigen::Map<RowMajor>(*jacobians, reduced_.rows(), size) = reduced_.middleCols(column, size);
      column += size;
      ++jacobians;
    }
  }

  const CycleModel& model_;
  mutable std::vector<double> point_;  ///< at which both are, where the slip is integrated
  mutable Eigen::VectorXd residuals_;
  mutable Eigen::MatrixXd jacobian_;
  mutable RowMajor reduced_;
};

template <class From>
void copy_unless_null(const From& from, double* to) {
  if (to != nullptr) std::copy(from.begin(), from.end(), to);
}

/// Parameter blocks: globals of Coulomb friction, own of the first cycle, own of the second.
class RampCost : public ceres::SizedCostFunction<1, globals_of(FrictionLaw::Coulomb), 2, 2> {
 public:
  RampCost(const BlockFit& fit, std::size_t first) : fit_(fit), first_(first) {}

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const RampResidual ramp = ramp_residual(fit_, first_, parameters[0], parameters[1], parameters[2]);
    if (!std::isfinite(ramp.value)) return false;
    residuals[0] = ramp.value;
    if (jacobians == nullptr) return true;
    copy_unless_null(ramp.d_globals, jacobians[0]);
    copy_unless_null(ramp.d_first, jacobians[1]);
    copy_unless_null(ramp.d_second, jacobians[2]);
    return true;
  }

 private:
  const BlockFit& fit_;
  std::size_t first_;
};

/// Parameter blocks: globals, level.
class SteadyCost : public ceres::CostFunction {
 public:
  SteadyCost(const SteadyRun& run, const Units& units, FrictionLaw law) : run_(run), units_(units), law_(law) {
    set_num_residuals(1);
    *mutable_parameter_block_sizes() = {static_cast<int>(globals_of(law)), 1};
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const auto count = static_cast<std::size_t>(parameter_block_sizes()[0]);
    Globals globals{};
    std::copy_n(parameters[0], count, globals.begin());
    const SteadyResidual steady = steady_residual(run_, units_, law_, globals.data(), *parameters[1]);
    if (!std::isfinite(steady.value)) return false;
    residuals[0] = steady.value;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) std::copy_n(steady.by_global.begin(), count, jacobians[0]);
    if (jacobians[1] != nullptr) *jacobians[1] = steady.by_level;
    return true;
  }

 private:
  const SteadyRun& run_;
  const Units& units_;
  FrictionLaw law_;
};

}  // namespace slipfit::fit
