#include "fit/inference/smoothing.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "fit/inference/covariance.hpp"
#include "fit/inference/uncertainty.hpp"

namespace slipfit::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Moving average of the trial: its effect on the slip is still of second order, and it reaches over several samples.
constexpr double kTrialShare = 0.15;  // of the half period
constexpr double kTrialSteps = 2.0;
constexpr std::size_t kMostCycles = 256;  // more would not tell it better than needed

/// A cycle's part of the normal equations of the common parameters and sigma^2, its own parameters eliminated.
struct Part {
  MatrixXd common;      // C' C
  VectorXd cross;       // C' d
  VectorXd score;       // C' r
  double square;        // d' d
  double pull;          // d' r
  VectorXd local_step;  // of the own parameters with sigma^2
  MatrixXd response;    // of the own parameters with the common ones
};

/// Residuals with a wider moving average than the model's.
VectorXd averaged_residuals(const BlockFit& wider, std::size_t cycle) {
  VectorXd residuals(static_cast<Index>(wider.model(cycle).residuals()));
  if (!wider.model(cycle).evaluate(wider.values(cycle), residuals.data(), nullptr)) {
    residuals.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return residuals;
}

Part part_of(const BlockFit& fit, const BlockFit& wider, std::size_t cycle, double variance_s2) {
  const Linearised lines = linearise(fit, cycle);
  const VectorXd change = (averaged_residuals(wider, cycle) - lines.residuals) / variance_s2;
  const Eigen::LDLT<MatrixXd> local(lines.local.transpose() * lines.local);
  const MatrixXd response = -local.solve(lines.local.transpose() * lines.common);
  const VectorXd local_step = -local.solve(lines.local.transpose() * change);
  const MatrixXd common = lines.common + lines.local * response;
  const VectorXd rest = change + lines.local * local_step;
  return {common.transpose() * common,
          common.transpose() * rest,
          common.transpose() * lines.residuals,
          rest.squaredNorm(),
          rest.dot(lines.residuals),
          local_step,
          response};
}

/// Of cycles from the first to the last.
std::vector<Part> parts_of(const BlockFit& fit, double variance_s2, double average_s) {
  Scales scales = fit.scales();
  scales.sensor_average_s = average_s;
  BlockFit wider(fit.set(), scales);
  wider.parameters = fit.parameters;
  const std::size_t step = 1 + fit.size() / kMostCycles;
  std::vector<Part> parts;
  for (std::size_t i = 0; i < fit.size(); i += step) parts.push_back(part_of(fit, wider, i, variance_s2));
  return parts;
}

}  // namespace

bool Smoothing::exceeds_step(double sample_interval_s) const {
  return variance_s2 - thresholds::kRoundedSigmas * standard_error_s2 > sample_interval_s * sample_interval_s / 12.0;
}

bool Smoothing::is_settled() const {
  return std::abs(variance_s2) < thresholds::kSettledAverage * standard_error_s2;
}

double Smoothing::next_variance_s2(double known_s2) const {
  constexpr double kMostChange = 4.0;
  return std::clamp(known_s2 + variance_s2, known_s2 / kMostChange, kMostChange * known_s2);
}

std::optional<Smoothing> estimate_smoothing(const BlockFit& fit, const Held& held, double sample_interval_s) {
  const double known_s = fit.scales().sensor_average_s;
  const double trial_s = std::max(kTrialShare * fit.scales().half_period_s, kTrialSteps * sample_interval_s);
  const double variance_s2 = trial_s * trial_s / 12.0;
  const std::vector<Part> parts = parts_of(fit, variance_s2, std::hypot(known_s, trial_s));
  const auto common = static_cast<Index>(fit.model(0).common_parameters());
  MatrixXd hessian = MatrixXd::Zero(common, common);
  VectorXd cross = VectorXd::Zero(common);
  double square = 0.0;
  for (const Part& part : parts) {
    hessian += part.common;
    cross += part.cross;
    square += part.square;
  }
  hold_rows(hessian, held);
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (held[i] && static_cast<Index>(i) < common) cross(static_cast<Index>(i)) = 0.0;
  }
  const VectorXd common_step = -hessian.ldlt().solve(cross);
  const double information = square + cross.dot(common_step);
  if (!(information > 1e-9 * square) || !common_step.allFinite()) return std::nullopt;
  double gradient = 0.0;
  double spread = 0.0;
  VectorXd local_step = VectorXd::Zero(static_cast<Index>(fit.model(0).local_parameters()));
  const auto count = static_cast<double>(parts.size());
  for (const Part& part : parts) {
    const double score = part.pull + common_step.dot(part.score);
    gradient += score;
    spread += score * score;
    local_step += (part.local_step + part.response * common_step) / count;
  }
  const Selection selection = select(fit);
  Smoothing result;
  result.variance_s2 = -gradient / information;
  result.standard_error_s2 = std::sqrt(spread * count / std::max(1.0, count - 1.0)) / information;
  result.move_per_s2 = selection.common.transpose() * common_step + selection.local.transpose() * local_step;
  return result;
}

}  // namespace slipfit::fit
