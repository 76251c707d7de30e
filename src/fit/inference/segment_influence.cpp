#include "fit/inference/segment_influence.hpp"

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
  MatrixXd hessian;     // common x common
  VectorXd gradient;    // what the samples left out no longer pull
  VectorXd local_step;  // sum over the cycles at unmoved common parameters
  MatrixXd response;    // sum over the cycles of d own / d common
};

struct Rows {
  Index begin = 0;
  Index count = 0;
};

/// The samples of a stretch are neighbours.
std::array<Rows, kSegments> stretches_of(const BlockFit& fit, std::size_t cycle) {
  std::array<Rows, kSegments> stretches;
  const CycleState state = fit.state(cycle);
  const std::vector<double>& time_s = fit.data(cycle).time_s;
  for (std::size_t j = 0; j < time_s.size(); ++j) {
    const std::optional<std::size_t> segment = segment_of(state, time_s[j]);
    if (!segment) continue;
    Rows& rows = stretches[*segment];
    if (rows.count++ == 0) rows.begin = static_cast<Index>(j);
  }
  return stretches;
}

/// As the fit was weighted.
double weight_of(const Linearised& cycle) {
  return huber_weight(cycle.residuals.norm(), static_cast<std::size_t>(cycle.residuals.size())).factor;
}

class SegmentInfluence {
 public:
  SegmentInfluence(const BlockFit& fit, const Held& held) : fit_(fit), held_(held) {
    const auto common = static_cast<Index>(fit.model(0).common_parameters());
    const auto local = static_cast<Index>(fit.model(0).local_parameters());
    reduced_.fill(
        {MatrixXd::Zero(common, common), VectorXd::Zero(common), VectorXd::Zero(local), MatrixXd::Zero(local, common)});
    for (std::size_t i = 0; i < fit.size(); ++i) add(i);
  }

  Moves moves() {
    const Selection selection = select(fit_);
    Moves moves(kSegments, kCoordinates);
    Index known = 0;
    for (Reduced& without : reduced_) {
      hold_rows(without.hessian, held_);
      for (std::size_t i = 0; i < held_.size(); ++i) {
        if (held_[i]) without.gradient(static_cast<Index>(i)) = 0.0;
      }
      const VectorXd step = without.hessian.ldlt().solve(without.gradient);
      if (!step.allFinite() || !without.local_step.allFinite()) continue;
      const VectorXd local_step = (without.local_step + without.response * step) / static_cast<double>(fit_.size());
      moves.row(known++) = (selection.common.transpose() * step + selection.local.transpose() * local_step).transpose();
    }
    return moves.topRows(known);
  }

 private:
  void add(std::size_t cycle) {
    const Linearised lines = linearise(fit_, cycle);
    const double weight = weight_of(lines);
    const MatrixXd local = lines.local.transpose() * lines.local;
    const MatrixXd cross = lines.common.transpose() * lines.local;
    const MatrixXd common = lines.common.transpose() * lines.common;
    const std::array<Rows, kSegments> stretches = stretches_of(fit_, cycle);
    for (std::size_t p = 0; p < kSegments; ++p) {
      const auto left_local = lines.local.middleRows(stretches[p].begin, stretches[p].count);
      const auto left_common = lines.common.middleRows(stretches[p].begin, stretches[p].count);
      const auto left_residuals = lines.residuals.segment(stretches[p].begin, stretches[p].count);
      const MatrixXd kept_cross = cross - left_common.transpose() * left_local;
      const VectorXd local_pull = left_local.transpose() * left_residuals;
      const Eigen::LDLT<MatrixXd> factor(local - left_local.transpose() * left_local);
      const MatrixXd response = -factor.solve(kept_cross.transpose());
      Reduced& without = reduced_[p];
      without.hessian += weight * (common - left_common.transpose() * left_common + kept_cross * response);
      without.gradient += weight * (left_common.transpose() * left_residuals + response.transpose() * local_pull);
      without.local_step += factor.solve(local_pull);
      without.response += response;
    }
  }

  const BlockFit& fit_;
  Held held_;
  std::array<Reduced, kSegments> reduced_;
};

}  // namespace

Moves influence_of_segments(const BlockFit& fit, const Held& held) {
  return SegmentInfluence(fit, held).moves();
}

}  // namespace slipfit::fit
