#include "fit/joint_quantities.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "fit/intervals.hpp"
#include "fit/joint_ageing.hpp"
#include "model/ageing.hpp"
#include "model/velocity_track.hpp"

namespace slipfit::fit {
namespace {

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

/// Without ageing a level line: the mean.
AgeingLine static_friction_line(const JointSolution& solution, StaticFriction kind) {
  if (kind == StaticFriction::Ages) return ageing_line(solution);
  const std::vector<double>& differences = solution.problem->parameters.differences;
  const auto count = static_cast<Eigen::Index>(differences.size());
  return {Eigen::VectorXd::Constant(count, 1.0 / static_cast<double>(count)), Eigen::VectorXd::Zero(count),
          static_cast<double>(count) * variance_of_mean(differences)};
}

}  // namespace

SweepVector sweep_values(const JointSolution& solution, StaticFriction kind) {
  const JointProblem::Parameters& parameters = solution.problem->parameters;
  const AgeingLine line = static_friction_line(solution, kind);
  const Eigen::Map<const Eigen::VectorXd> differences(parameters.differences.data(), line.rate_weights.size());
  SweepVector values;
  for (std::size_t i = 0; i < kJointShared; ++i) values(static_cast<Eigen::Index>(i)) = parameters.shared[i];
  values(kLevelValue) = mean(parameters.levels);
  values(kDifferenceValue) = line.difference_weights.dot(differences);
  values(kAgeingValue) = line.rate_weights.dot(differences);
  return values;
}

SweepMatrix sweep_covariance(const JointSolution& solution, const JointCovariance& covariance, StaticFriction kind) {
  const JointProblem& problem = *solution.problem;
  const AgeingLine line = static_friction_line(solution, kind);
  Eigen::MatrixXd selection = Eigen::MatrixXd::Zero(covariance.matrix.rows(), kSweepValues);
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(kJointShared); ++i) selection(i, i) = 1.0;
  const auto& levels = problem.parameters.levels;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    selection(static_cast<Eigen::Index>(problem.level_column(i)), kLevelValue) =
        1.0 / static_cast<double>(levels.size());
  }
  for (Eigen::Index i = 0; i < line.rate_weights.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(problem.difference_column(static_cast<std::size_t>(i)));
    selection(row, kDifferenceValue) = line.difference_weights(i);
    selection(row, kAgeingValue) = line.rate_weights(i);
  }
  SweepMatrix matrix = selection.transpose() * covariance.matrix * selection;
  matrix(kLevelValue, kLevelValue) += variance_of_mean(levels);
  Eigen::MatrixXd scatter(line.rate_weights.size(), 2);
  scatter << line.difference_weights, line.rate_weights;
  matrix.block<2, 2>(kDifferenceValue, kDifferenceValue) += line.residual_variance * scatter.transpose() * scatter;
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
  ageing = scales.force * jet(kAgeingValue);
  reference_stick_s_ = scales.stick_s;
}

SweepJet SweepModel::excess_friction(double speed_m_per_s) const {
  const SweepJet rate = alpha * speed_m_per_s;
  if (std::abs(rate.a) < 1e-6) return slope * speed_m_per_s * (1.0 + 0.5 * rate);
  return slope * (exp(rate) - 1.0) / alpha;
}

std::optional<SweepJet> SweepModel::spacing(double speed_m_per_s, double load) const {
  const std::optional<SweepJet> aged_N = aged_difference_N(speed_m_per_s, load);
  if (!aged_N) return std::nullopt;
  const std::optional<Cycle> limit = cycle(speed_m_per_s, load, *aged_N);
  if (!limit) return std::nullopt;
  return speed_m_per_s * limit->period_s;
}

std::optional<SweepModel::Cycle> SweepModel::cycle(double speed_m_per_s, double load,
                                                   const SweepJet& difference_N) const {
  const SweepJet u = stiffness * speed_m_per_s / omega;
  const SweepJet z0 = load * difference_N / u - 2.0 * zeta;  // the slip starts from F_s - cV
  const SweepJet scaled_slope = load * slope * omega / stiffness;
  const SweepJet rate = alpha * speed_m_per_s;
  const auto track = model::VelocityTrack::solve(z0.a, zeta.a, scaled_slope.a, rate.a);
  if (!track || !track->resticks()) return std::nullopt;
  const auto jet = [&](double value, const auto& p) {
    SweepJet y(value);
    y.v = p.d_z0 * z0.v + p.d_zeta * zeta.v + p.d_slope * scaled_slope.v + p.d_rate * rate.v;
    return y;
  };
  const model::TrackLine line = track->after();
  const SweepJet tau_period = z0 - jet(line.intercept, line);
  const model::TrackEnd& end = track->end();
  SweepJet tau_slip(end.tau);
  tau_slip.v = -jet(end.first.value, end.first).v / end.second.value;  // z'(tau) = 1 holds at the end
  return Cycle{tau_period / omega, (tau_period - tau_slip) / omega};
}

std::optional<SweepJet> SweepModel::aged_difference_N(double speed_m_per_s, double load) const {
  if (ageing.a == 0.0) return difference;
  const auto stick_of = [&](double difference_N) -> std::optional<SweepJet> {
    SweepJet held_N(difference_N, kDifferenceValue);
    const std::optional<Cycle> limit = cycle(speed_m_per_s, load, held_N);
    return limit ? std::optional(limit->stick_s) : std::nullopt;
  };
  const model::AgeingLaw law{difference.a, ageing.a, reference_stick_s_};
  const std::optional<double> solution_N =
      model::aged_difference_N(law, [&](double difference_N) -> std::optional<model::StickTime> {
        const std::optional<SweepJet> stick_s = stick_of(difference_N);
        if (!stick_s) return std::nullopt;
        return model::StickTime{stick_s->a, stick_s->v(kDifferenceValue)};
      });
  if (!solution_N) return std::nullopt;
  SweepJet stick_s = *stick_of(*solution_N);
  const double by_difference = std::exchange(stick_s.v(kDifferenceValue), 0.0);
  return model::aged_difference_N(*solution_N, difference, ageing, stick_s, by_difference, reference_stick_s_);
}

// A matrix of fixed size has nothing to move: by value it would be copied twice.
// NOLINTNEXTLINE(modernize-pass-by-value)
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
