#include "fit/inference/phase_moves.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>

#include "fit/inference/covariance.hpp"
#include "fit/inference/misfit.hpp"
#include "fit/inference/uncertainty.hpp"

namespace slipfit::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The normal equations without one stretch, each cycle's own parameters eliminated.
struct Reduced {
  MatrixXd hessian;   // common x common
  VectorXd gradient;  // what the samples left out no longer pull
  VectorXd own_step;  // sum over the cycles at unmoved common parameters
  MatrixXd response;  // sum over the cycles of d own / d common
};

struct Rows {
  Index begin = 0;
  Index count = 0;
};

/// The samples of a stretch are neighbours.
std::array<Rows, kPhases> stretches_of(const BlockFit& fit, std::size_t cycle) {
  std::array<Rows, kPhases> stretches;
  const CycleState state = fit.state(cycle);
  const std::vector<double>& time_s = fit.data(cycle).time_s;
  for (std::size_t j = 0; j < time_s.size(); ++j) {
    const std::optional<std::size_t> phase = phase_of(state, time_s[j]);
    if (!phase) continue;
    Rows& rows = stretches[*phase];
    if (rows.count++ == 0) rows.begin = static_cast<Index>(j);
  }
  return stretches;
}

/// As the fit was weighted: a cycle far worse than the others counts linearly (SolveOptions::robust).
double weight_of(const Linearised& cycle) {
  return std::min(1.0, huber_bound(static_cast<std::size_t>(cycle.residuals.size())) / cycle.residuals.norm());
}

class PhaseMoves {
 public:
  PhaseMoves(const BlockFit& fit, const Held& held) : fit_(fit), held_(held) {
    const auto common = static_cast<Index>(fit.model(0).common_parameters());
    const auto own = static_cast<Index>(fit.model(0).own_parameters());
    reduced_.fill(
        {MatrixXd::Zero(common, common), VectorXd::Zero(common), VectorXd::Zero(own), MatrixXd::Zero(own, common)});
    for (std::size_t i = 0; i < fit.size(); ++i) add(i);
  }

  Moves moves() {
    const Selection selection = select(fit_);
    Moves moves(kPhases, kCoordinates);
    Index known = 0;
    for (Reduced& without : reduced_) {
      hold_rows(without.hessian, held_);
      for (std::size_t i = 0; i < held_.size(); ++i) {
        if (held_[i]) without.gradient(static_cast<Index>(i)) = 0.0;
      }
      const VectorXd step = without.hessian.ldlt().solve(without.gradient);
      if (!step.allFinite() || !without.own_step.allFinite()) continue;
      const VectorXd own_step = (without.own_step + without.response * step) / static_cast<double>(fit_.size());
      moves.row(known++) = (selection.common.transpose() * step + selection.own.transpose() * own_step).transpose();
    }
    return moves.topRows(known);
  }

 private:
  void add(std::size_t cycle) {
    const Linearised lines = linearise(fit_, cycle);
    const double weight = weight_of(lines);
    const MatrixXd own = lines.own.transpose() * lines.own;
    const MatrixXd cross = lines.common.transpose() * lines.own;
    const MatrixXd common = lines.common.transpose() * lines.common;
    const std::array<Rows, kPhases> stretches = stretches_of(fit_, cycle);
    for (std::size_t p = 0; p < kPhases; ++p) {
      const auto left_own = lines.own.middleRows(stretches[p].begin, stretches[p].count);
      const auto left_common = lines.common.middleRows(stretches[p].begin, stretches[p].count);
      const auto left_residuals = lines.residuals.segment(stretches[p].begin, stretches[p].count);
      const MatrixXd kept_cross = cross - left_common.transpose() * left_own;
      const VectorXd own_pull = left_own.transpose() * left_residuals;
      const Eigen::LDLT<MatrixXd> factor(own - left_own.transpose() * left_own);
      const MatrixXd response = -factor.solve(kept_cross.transpose());
      Reduced& without = reduced_[p];
      without.hessian += weight * (common - left_common.transpose() * left_common + kept_cross * response);
      without.gradient += weight * (left_common.transpose() * left_residuals + response.transpose() * own_pull);
      without.own_step += factor.solve(own_pull);
      without.response += response;
    }
  }

  const BlockFit& fit_;
  Held held_;
  std::array<Reduced, kPhases> reduced_;
};

}  // namespace

Moves moves_by_phase(const BlockFit& fit, const Held& held) {
  return PhaseMoves(fit, held).moves();
}

}  // namespace slipfit::fit
