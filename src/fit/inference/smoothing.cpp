#include "fit/inference/smoothing.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "fit/inference/covariance.hpp"
#include "fit/inference/uncertainty.hpp"
#include "fit/problem/lines.hpp"

namespace slipfit::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Moving average of the trial: its effect on the slip is still of second order, and it reaches over several samples.
constexpr double kTrialShare = 0.15;  // of the half period
constexpr double kTrialSteps = 2.0;
constexpr std::size_t kMostCycles = 256;  // more would determine it better than needed

/// Residuals with a wider moving average than the model's.
VectorXd averaged_residuals(const BlockFit& wider, std::size_t cycle) {
  VectorXd residuals(static_cast<Index>(wider.model(cycle).residuals()));
  if (!wider.model(cycle).evaluate(wider.values(cycle), residuals.data(), nullptr)) {
    residuals.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return residuals;
}

/// The normal equations with two sides: d = dr / d sigma^2 and the residuals r.
struct TwoSides {
  Elimination all;
  std::vector<RowMajor> cycles;  ///< their parts, own parameters eliminated
};

/// Of cycles from the first to the last. `columns` must outlive the result.
TwoSides two_sides_of(const BlockFit& fit, const std::vector<Index>& columns, double variance_s2, double average_s) {
  Scales scales = fit.scales();
  scales.sensor_average_s = average_s;
  const BlockFit wider = fit.with_scales(scales);
  TwoSides sides{Elimination(static_cast<Index>(columns.size()), 0.0, 2), {}};
  MatrixXd lines;
  const std::size_t step = 1 + fit.size() / kMostCycles;
  for (std::size_t i = 0; i < fit.size(); i += step) {
    evaluate_lines(fit.model(i), fit.values(i), lines);
    const VectorXd residuals = lines.rightCols<1>();
    lines.rightCols<1>() = (averaged_residuals(wider, i) - residuals) / variance_s2;
    lines.conservativeResize(Eigen::NoChange, lines.cols() + 1);
    lines.rightCols<1>() = residuals;
    sides.all.add_cycle(products_of(lines), columns);
    sides.cycles.push_back(sides.all.latest());
  }
  return sides;
}

}  // namespace

bool Smoothing::exceeds_step(double sample_interval_s) const {
  return variance_s2 - thresholds::kLikelySigmas * standard_error_s2 > sample_interval_s * sample_interval_s / 12.0;
}

std::optional<Smoothing> estimate_smoothing(const BlockFit& fit, const Held& held, double sample_interval_s) {
  if (fit.solves_for(kSensorTime)) return std::nullopt;
  const double known_s = fit.sensor().average_s;
  const double trial_s = std::max(kTrialShare * fit.scales().half_period_s, kTrialSteps * sample_interval_s);
  const double variance_s2 = trial_s * trial_s / 12.0;
  const CommonColumns columns(Problem{{&fit, 1}});
  const Index common = columns.size();
  const TwoSides sides = two_sides_of(fit, columns.of(0), variance_s2, std::hypot(known_s, trial_s));
  const RowMajor& sum = sides.all.common();
  const MatrixXd steps = common_steps(sum, 2, columns.held(held));
  const VectorXd common_step = steps.col(0);
  const double square = sum(common, common);
  const double information = square + sum.col(common).head(common).dot(common_step);
  // Rounding may leave a sum of squares below 0 where nothing is left of it.
  if (!(information > std::max(0.0, 1e-9 * square)) || !common_step.allFinite()) return std::nullopt;
  double gradient = 0.0;
  double spread = 0.0;
  for (const RowMajor& part : sides.cycles) {
    const double score = part(common, common + 1) + common_step.dot(part.col(common + 1).head(common));
    gradient += score;
    spread += score * score;
  }
  const auto count = static_cast<double>(sides.cycles.size());
  Smoothing result;
  result.variance_s2 = -gradient / information;
  result.standard_error_s2 = std::sqrt(spread * count / std::max(1.0, count - 1.0)) / information;
  result.move_per_s2 = move_of(select(fit), sides.all, steps);
  return result;
}

}  // namespace slipfit::fit
