#include "fit/joint_quantities.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fit/intervals.hpp"
#include "model/velocity_track.hpp"

namespace slipfit::fit {
namespace {

constexpr int kLevelValue = 5;
constexpr int kDifferenceValue = 6;

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Squared standard error of the mean of what the recordings have each for themselves.
double variance_of_mean(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  if (values.size() < 2) return 0.0;
  const double centre = mean(values);
  double square = 0.0;
  for (const double value : values) square += (value - centre) * (value - centre);
  return square / (count * (count - 1.0));
}

}  // namespace

SweepVector sweep_values(const JointSolution& solution) {
  const JointProblem::Parameters& parameters = solution.problem->parameters;
  SweepVector values;
  for (std::size_t i = 0; i < kJointShared; ++i) values(static_cast<Eigen::Index>(i)) = parameters.shared[i];
  values(kLevelValue) = mean(parameters.levels);
  values(kDifferenceValue) = mean(parameters.differences);
  return values;
}

SweepMatrix sweep_covariance(const JointSolution& solution, const JointCovariance& covariance) {
  const JointProblem& problem = *solution.problem;
  Eigen::MatrixXd selection = Eigen::MatrixXd::Zero(covariance.matrix.rows(), kSweepValues);
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(kJointShared); ++i) selection(i, i) = 1.0;
  const auto& levels = problem.parameters.levels;
  const auto& differences = problem.parameters.differences;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    selection(static_cast<Eigen::Index>(problem.level_column(i)), kLevelValue) =
        1.0 / static_cast<double>(levels.size());
  }
  for (std::size_t i = 0; i < differences.size(); ++i) {
    selection(static_cast<Eigen::Index>(problem.difference_column(i)), kDifferenceValue) =
        1.0 / static_cast<double>(differences.size());
  }
  SweepMatrix matrix = selection.transpose() * covariance.matrix * selection;
  matrix(kLevelValue, kLevelValue) += variance_of_mean(levels);
  matrix(kDifferenceValue, kDifferenceValue) += variance_of_mean(differences);
  return matrix;
}

SweepVector with_damping_cut(const SweepVector& values, const SweepMatrix& covariance) {
  const double variance = covariance(kJointDamping, kJointDamping);
  if (!(values(kJointDamping) < 0.0) || !(variance > 0.0)) return values;
  SweepVector cut = values - covariance.col(kJointDamping) * (values(kJointDamping) / variance);
  cut(kJointDamping) = 0.0;
  return cut;
}

SweepModel::SweepModel(const SweepVector& values, const JointScales& scales) {
  const auto jet = [&](int i) { return SweepJet(values(i), i); };
  stiffness = exp(jet(kJointStiffness));
  omega = exp(jet(kJointFrequency));
  zeta = jet(kJointDamping);
  const SlopeRatio ratio = slope_ratio(values(kFrictionRate));
  SweepJet ratio_jet(ratio.value);
  ratio_jet.v(kFrictionRate) = ratio.derivative;
  slope = 2.0 * jet(kFrictionSlope) * ratio_jet * stiffness / omega;
  alpha = jet(kFrictionRate) / scales.slip_speed_m_per_s;
  level = scales.force * jet(kLevelValue);
  difference = scales.force * jet(kDifferenceValue);
}

SweepJet SweepModel::excess_friction(double speed_m_per_s) const {
  const SweepJet rate = alpha * speed_m_per_s;
  if (std::abs(rate.a) < 1e-6) return slope * speed_m_per_s * (1.0 + 0.5 * rate);
  return slope * (exp(rate) - 1.0) / alpha;
}

std::optional<SweepJet> SweepModel::spacing(double speed_m_per_s, double load) const {
  const SweepJet u = stiffness * speed_m_per_s / omega;
  const SweepJet z0 = load * difference / u - 2.0 * zeta;  // the slip starts from F_s - cV
  const SweepJet scaled_slope = load * slope * omega / stiffness;
  const SweepJet rate = alpha * speed_m_per_s;
  const auto track = model::VelocityTrack::solve(z0.a, zeta.a, scaled_slope.a, rate.a);
  if (!track || !track->resticks()) return std::nullopt;
  const model::TrackLine line = track->after();
  SweepJet intercept(line.intercept);
  intercept.v = line.d_z0 * z0.v + line.d_zeta * zeta.v + line.d_slope * scaled_slope.v + line.d_rate * rate.v;
  return speed_m_per_s * (z0 - intercept) / omega;
}

SweepIntervals::SweepIntervals(const SweepMatrix& covariance, double degrees_of_freedom)
    : matrix_(covariance),
      degrees_of_freedom_(std::max(1.0, degrees_of_freedom)),
      quantile_(t_quantile(degrees_of_freedom_)) {}

double SweepIntervals::error(const SweepJet& y) const {
  return std::sqrt(std::max(0.0, covariance(y, y)));
}

Estimate SweepIntervals::plain(const SweepJet& y) const {
  const double se = error(y);
  return {y.a, se, Interval{y.a - quantile_ * se, y.a + quantile_ * se}, {}};
}

Estimate SweepIntervals::of_one_sign(const SweepJet& y) const {
  const double se = error(y);
  const double factor = std::exp(quantile_ * se / std::abs(y.a));
  return {y.a, se, Interval{std::min(y.a / factor, y.a * factor), std::max(y.a / factor, y.a * factor)}, {}};
}

Estimate SweepIntervals::through_rate(const SweepVector& values, const JointScales& scales,
                                      const std::function<SweepJet(const SweepModel&)>& quantity) const {
  const double variance = matrix_(kFrictionRate, kFrictionRate);
  const SweepVector follow = matrix_.col(kFrictionRate) / variance;
  const double reach = quantile_ * std::sqrt(variance);
  const SweepJet y = quantity(SweepModel(values, scales));
  const double along = y.v.dot(follow);  // d y / d rate, the others following
  const double held = std::sqrt(std::max(0.0, covariance(y, y) - along * along * variance));
  Interval ends{y.a, y.a};
  for (const double side : {-reach, reach}) {
    const double end = quantity(SweepModel(values + side * follow, scales)).a;
    ends = {std::min(ends.low, end), std::max(ends.high, end)};
  }
  const Interval ci{y.a - std::hypot(y.a - ends.low, quantile_ * held),
                    y.a + std::hypot(ends.high - y.a, quantile_ * held)};
  return {y.a, 0.5 * (ci.high - ci.low) / quantile_, ci, {}};
}

}  // namespace slipfit::fit
