#pragma once

#include <ceres/cost_function.h>
#include <ceres/sized_cost_function.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "fit/problem/block_fit.hpp"
#include "fit/problem/ramp_residual.hpp"
#include "fit/problem/steady_run.hpp"

namespace slipfit::fit {

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
