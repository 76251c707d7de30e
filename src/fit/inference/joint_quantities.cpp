#include "fit/inference/joint_quantities.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "fit/inference/intervals.hpp"
#include "fit/inference/joint_ageing.hpp"
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

SweepIntervals::SweepIntervals(const SweepMatrix& covariance, double degrees_of_freedom, const RateProfile& profile)
    : matrix_(covariance),
      rate_held_(covariance),
      degrees_of_freedom_(std::max(1.0, degrees_of_freedom)),
      quantile_(t_quantile(degrees_of_freedom_)) {
  const double variance = covariance(kFrictionRate, kFrictionRate);
  if (!(variance > 0.0)) return;
  const SweepVector along = covariance.col(kFrictionRate) / std::sqrt(variance);
  rate_held_ -= along * along.transpose();
  SweepMatrix by_profile = SweepMatrix::Zero();
  for (const auto* side : {&profile.lower, &profile.higher}) {
    if (side->empty()) continue;
    const SweepVector end = side->back().move / quantile_;
    by_profile += 0.5 * end * end.transpose();
    for (const RateProfile::Point& point : *side) moves_.push_back(point.move);
  }
  const bool is_wider = by_profile(kFrictionRate, kFrictionRate) > variance;
  if (is_wider) matrix_ = rate_held_ + by_profile;
  for (const double side : {-quantile_, quantile_}) moves_.emplace_back(side * along);
}

double SweepIntervals::error(const SweepJet& y) const {
  return std::sqrt(std::max(0.0, covariance(y, y)));
}

SweepIntervals::Reach SweepIntervals::reach_of(const SweepJet& y, const std::vector<double>& changes) const {
  Reach reach;
  for (const double change : changes) {
    reach.down = std::max(reach.down, -change);
    reach.up = std::max(reach.up, change);
  }
  const double held = quantile_ * std::sqrt(std::max(0.0, y.v.dot(rate_held_ * y.v)));
  return {std::hypot(reach.down, held), std::hypot(reach.up, held)};
}

SweepIntervals::Reach SweepIntervals::reach_of(const SweepJet& y) const {
  std::vector<double> changes;
  for (const SweepVector& move : moves_) changes.push_back(y.v.dot(move));
  return reach_of(y, changes);
}

Estimate SweepIntervals::from_reach(double value, const Reach& reach) const {
  return {value, std::max(reach.down, reach.up) / quantile_, Interval{value - reach.down, value + reach.up}, {}};
}

Estimate SweepIntervals::plain(const SweepJet& y) const {
  return from_reach(y.a, reach_of(y));
}

Estimate SweepIntervals::of_one_sign(const SweepJet& y) const {
  const Reach reach = reach_of(y);
  const bool is_positive = y.a > 0.0;
  const double shrink = std::exp(-(is_positive ? reach.down : reach.up) / std::abs(y.a));
  const double grow = std::exp((is_positive ? reach.up : reach.down) / std::abs(y.a));
  Estimate estimate = from_reach(y.a, reach);
  estimate.ci95 = Interval{std::min(y.a * shrink, y.a * grow), std::max(y.a * shrink, y.a * grow)};
  return estimate;
}

Estimate SweepIntervals::through_rate(const SweepVector& values, const JointScales& scales,
                                      const std::function<SweepJet(const SweepModel&)>& quantity) const {
  const SweepJet y = quantity(SweepModel(values, scales));
  std::vector<double> changes;
  for (const SweepVector& move : moves_) changes.push_back(quantity(SweepModel(values + move, scales)).a - y.a);
  return from_reach(y.a, reach_of(y, changes));
}

}  // namespace slipfit::fit
