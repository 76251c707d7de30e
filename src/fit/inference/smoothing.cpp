#include "fit/inference/smoothing.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "core/thresholds.hpp"
#include "fit/inference/covariance.hpp"
#include "fit/inference/uncertainty.hpp"
#include "fit/problem/normals.hpp"

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

namespace {

/// Returns the nearest integer for |x| < 2^51, without a call: the last bit of the sum is 1.
double nearest_integer(double x) {
  constexpr double kLastBitIsOne = 0x1.8p52;
  return (x + kLastBitIsOne) - kLastBitIsOne;
}

}  // namespace

RoundedCopies::RoundedCopies(std::vector<double> model, double step, double residual_rms)
    : model_(std::move(model)), step_(step), noise_(model_.size()) {
  const double rms = std::sqrt(std::max(0.0, residual_rms * residual_rms - step * step / 12.0));
  std::mt19937_64 generator(0);
  boost::random::normal_distribution<double> normal(0.0, rms);
  std::ranges::generate(noise_, [&] { return normal(generator); });
}

std::vector<double> RoundedCopies::draw(unsigned copy) const {
  std::mt19937_64 generator(copy + 1);
  boost::random::uniform_01<double> uniform;
  const double origin = step_ * uniform(generator);
  const auto count = static_cast<double>(model_.size());
  auto noise = noise_.begin() + static_cast<std::ptrdiff_t>(count * uniform(generator));
  std::vector<double> forces;
  forces.reserve(model_.size());
  for (const double force : model_) {
    const double steps = (force + *noise - origin) / step_;
    forces.push_back(step_ * nearest_integer(steps) + origin);
    if (++noise == noise_.end()) noise = noise_.begin();
  }
  return forces;
}

Uncertainty with_rounding(Uncertainty uncertainty, const Moves& moves) {
  uncertainty.from_refits = true;
  const CoordinateMatrix spread = moves.transpose() * moves / static_cast<double>(moves.rows());
  if (uncertainty.from_cycles) {
    uncertainty.covariance += spread;
  } else {
    uncertainty.covariance = spread;
    uncertainty.degrees_of_freedom = std::min(uncertainty.degrees_of_freedom, static_cast<double>(moves.rows()));
  }
  return uncertainty;
}

}  // namespace slipfit::fit
