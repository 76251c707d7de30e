#include "fit/inference/segment_influence.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>

#include "fit/inference/covariance.hpp"
#include "fit/inference/misfit.hpp"
#include "fit/inference/uncertainty.hpp"
#include "fit/problem/lines.hpp"

namespace slipfit::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

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

/// The normal equations without one stretch of each cycle, for every stretch.
class SegmentInfluence {
 public:
  explicit SegmentInfluence(const BlockFit& fit)
      : fit_(fit), columns_(Problem{{&fit, 1}}), without_(kSegments, Elimination(columns_.size())) {
    for (std::size_t i = 0; i < fit.size(); ++i) add(i);
  }

  [[nodiscard]] Moves moves(const Held& held) const {
    const Selection selection = select(fit_);
    Moves moves(kSegments, kCoordinates);
    Index known = 0;
    for (const Elimination& without : without_) {
      const VectorXd step = common_steps(without.common(), 1, columns_.held(held));
      if (!step.allFinite() || without.is_singular()) continue;
      moves.row(known++) = move_of(selection, without, step).transpose();
    }
    return moves.topRows(known);
  }

 private:
  void add(std::size_t cycle) {
    evaluate_lines(fit_.model(cycle), fit_.values(cycle), lines_);
    const auto residuals = lines_.rightCols<1>();
    const double weight = huber_weight(residuals.norm(), static_cast<std::size_t>(residuals.size())).factor;
    const RowMajor all = products_of(lines_);
    const std::array<Rows, kSegments> stretches = stretches_of(fit_, cycle);
    for (std::size_t p = 0; p < kSegments; ++p) {
      const RowMajor left = products_of(lines_.middleRows(stretches[p].begin, stretches[p].count));
      RowMajor kept = weight * (all - left);
      kept.rightCols<1>() = -weight * left.rightCols<1>();  // with all samples nothing pulls
      without_[p].add_cycle(kept, columns_.of(0));
    }
  }

  const BlockFit& fit_;
  CommonColumns columns_;
  std::vector<Elimination> without_;
  MatrixXd lines_;
};

}  // namespace

Moves influence_of_segments(const BlockFit& fit, const Held& held) {
  return SegmentInfluence(fit).moves(held);
}

}  // namespace slipfit::fit
