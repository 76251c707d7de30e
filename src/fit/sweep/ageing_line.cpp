#include "fit/sweep/ageing_line.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "fit/law/speed_dependent.hpp"

namespace slipfit::fit {

SlidingModel::SlidingModel(const Coordinates& values, const Units& units) {
  const auto jet = [&](int i) { return Jet(values(i), i); };
  stiffness = exp(jet(kLogStiffness));
  omega = exp(jet(kLogFrequency));
  zeta = jet(kDamping);
  const SlopeRatio ratio = slope_ratio(FrictionLaw::Exponential, values(kFrictionRate));
  Jet ratio_jet(ratio.value);
  ratio_jet.v(kFrictionRate) = ratio.derivative;
  slope = 2.0 * jet(kFrictionSlope) * ratio_jet * stiffness / omega;
  alpha = jet(kFrictionRate) / units.slip_speed_m_per_s;
  level = units.level + units.force * jet(kLevel);
  difference = units.force * jet(kDifference);
  ageing = units.force * jet(kAgeing);
  ageing_time = units.stick_s * jet(kAgeingTime);
  slip_distance = units.slip_distance_m * jet(kSlipDistance) * jet(kSlipDistance);
  if (values(kReloadForce) > 0.0) reload = Reload{units.force * jet(kReloadForce), exp(jet(kReloadLength))};
  if (values(kRelaxation) > 0.0) relaxation = Relaxation{jet(kRelaxation), exp(jet(kRelaxationTime))};
  stiffness_exponent = jet(kStiffnessExponent);
  if (values(kStiffnessDrift) != 0.0) stiffness_ratio = exp(2.0 * jet(kStiffnessDrift));
  reference_stick_s_ = units.stick_s;
  reference_speed_m_per_s_ = units.speed_m_per_s;
}

Jet SlidingModel::excess_friction(double speed_m_per_s) const {
  const Jet rate = alpha * speed_m_per_s;
  if (std::abs(rate.a) < 1e-6) return slope * speed_m_per_s * (1.0 + 0.5 * rate);
  return slope * (exp(rate) - 1.0) / alpha;
}

model::SlidingBody<Jet> SlidingModel::body_at(double speed_m_per_s, double load) const {
  const Jet growth = exp(stiffness_exponent * std::log(speed_m_per_s / reference_speed_m_per_s_));
  model::SlidingBody<Jet> body{speed_m_per_s, stiffness * growth, omega * sqrt(growth),  // of the same mass
                               zeta,          load * difference,  load * slope,         alpha};
  if (ageing.a != 0.0) body.ageing = {load * ageing, ageing_time, reference_stick_s_};
  if (reload) body.rise = {load * reload->force_N, reload->length_m};
  body.relaxation = relaxation;
  return body;
}

std::optional<Jet> SlidingModel::spacing(double speed_m_per_s, double load) const {
  model::SlidingBody<Jet> body = body_at(speed_m_per_s, load);
  const std::optional<Jet> aged_N = body.aged_difference_N();
  if (!aged_N) return std::nullopt;
  body.difference_N = *aged_N;
  const auto limit = body.cycle();
  return limit ? std::optional(speed_m_per_s * limit->period_s()) : std::nullopt;
}

std::optional<model::SlidingCycle<Jet>> SlidingModel::cycle(double speed_m_per_s, double load,
                                                            const Jet& difference_N) const {
  model::SlidingBody<Jet> body = body_at(speed_m_per_s, load);
  body.difference_N = load * difference_N;
  return body.cycle();
}

namespace {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd log_speeds(const SweepSolution& solution) {
  const std::vector<double> speeds = solution.speeds_m_per_s();
  return Eigen::Map<const VectorXd>(speeds.data(), static_cast<Index>(speeds.size())).array().log();
}

/// ln(stick / Units::stick_s) of the limit cycle with each recording's own F_s - F_k(0+). Where that does not stick,
/// from the straight ramp over twice F_s - F_k.
VectorXd log_sticks(const SweepSolution& solution) {
  const VectorXd differences = differences_of(solution);
  const Units& units = solution.sweep.units;
  Coordinates values = solution.shared();
  if (const VectorXd rises = rises_of(solution); rises.size() > 0) values(kReloadForce) = rises.mean();
  const SlidingModel model(values, units);
  VectorXd logs(differences.size());
  for (Index i = 0; i < differences.size(); ++i) {
    const auto recording = static_cast<std::size_t>(i);
    const double speed = solution.recordings[recording].scales().speed_m_per_s;
    const double load = solution.population(recording).load;
    const double difference_N = units.force * differences(i);
    const auto cycle = model.cycle(speed, load, Jet(difference_N));
    const double ramp_s = 2.0 * load * std::abs(difference_N) / (model.stiffness.a * speed);
    logs(i) = std::log((cycle && cycle->stick_s.a > 0.0 ? cycle->stick_s.a : ramp_s) / units.stick_s);
  }
  return logs;
}

/// Squared standard errors of the recordings' own F_s - F_k(0+), in its unit: by the scatter over their cycles.
VectorXd variances_of(const SweepSolution& solution) {
  VectorXd variances(static_cast<Index>(solution.recordings.size()));
  for (Index i = 0; i < variances.size(); ++i) {
    const auto recording = static_cast<std::size_t>(i);
    const Population& population = solution.population(recording);
    const auto cycles = static_cast<double>(solution.recordings[recording].size());
    variances(i) = std::pow(population.onset_sd / population.force, 2) / cycles;
  }
  return variances;
}

/// Returns whether the residuals of a line with two parameters are within the recordings' own errors.
bool within_own_errors(const VectorXd& residuals, const VectorXd& variances) {
  if (residuals.size() < 3) return true;
  const double sum = (residuals.array().square() / variances.array()).sum();
  return chi_squared_above(sum, static_cast<double>(residuals.size()) - 2.0) > thresholds::kAgeingChance;
}

/// A straight line of least squares over ln V.
struct Line {
  double slope = 0.0;
  double slope_error = 0.0;  ///< by the residuals; 0 for two points
  double explained = 0.0;    ///< share of the variance of the values
  VectorXd residuals;

  /// Returns the odds of the line against values that scatter around their mean, for a slope that has the sign that the
  /// line has, at even odds beforehand and with as much knowledge of the slope beforehand as one value gives (Zellner's
  /// g prior with g = n). Even where there are two values. docs/model.md (20c)
  [[nodiscard]] double odds() const {
    const auto n = static_cast<double>(residuals.size());
    return std::pow(1.0 + n, 0.5 * n - 1.0) * std::pow(1.0 + n * (1.0 - explained), 0.5 - 0.5 * n);
  }
};

Line line_over(VectorXd log_speeds, const VectorXd& values) {
  log_speeds.array() -= log_speeds.mean();
  Line line;
  line.slope = log_speeds.dot(values) / log_speeds.squaredNorm();
  line.residuals = values.array() - values.mean() - line.slope * log_speeds.array();
  const double freedom = static_cast<double>(values.size()) - 2.0;
  const double variance = (values.array() - values.mean()).square().sum();
  if (variance > 0.0) line.explained = 1.0 - line.residuals.squaredNorm() / variance;
  if (freedom > 0.0) {
    line.slope_error = std::sqrt(line.residuals.squaredNorm() / freedom / log_speeds.squaredNorm());
  }
  return line;
}

/// Lines through the recordings' own F_s - F_k(0+), one for each cut-off.
class LinesOverSticks {
 public:
  explicit LinesOverSticks(const SweepSolution& solution)
      : differences_(differences_of(solution)),
        variances_(variances_of(solution)),
        sticks_(log_sticks(solution).array().exp()),
        instrument_(log_speeds(solution)) {
    instrument_.array() -= instrument_.mean();
  }

  struct Line {
    VectorXd difference_weights, rate_weights, residuals;
    double difference = 0.0;
    double rate = 0.0;
    double chi2 = 0.0;  ///< by the recordings' own errors
  };
  [[nodiscard]] Line with(double cutoff) const {
    const VectorXd logs = ((sticks_.array() + cutoff) / (1.0 + cutoff)).log();
    Line line;
    line.rate_weights = instrument_ / instrument_.dot(logs);
    line.difference_weights = VectorXd::Constant(logs.size(), 1.0 / static_cast<double>(logs.size()));
    line.difference_weights -= logs.mean() * line.rate_weights;
    line.difference = line.difference_weights.dot(differences_);
    line.rate = line.rate_weights.dot(differences_);
    line.residuals = differences_.array() - line.difference - line.rate * logs.array();
    line.chi2 = least_chi2(logs);
    return line;
  }
  [[nodiscard]] const VectorXd& own_variances() const { return variances_; }
  /// Returns the largest variance of the recordings over that of their own errors: by the usual scatter of friction, or
  /// by all that they differ if that is more.
  [[nodiscard]] double largest_variance() const {
    const double usual = thresholds::kUsualScatter * differences_.mean();
    const double seen = (differences_.array() - differences_.mean()).square().mean();
    return std::max(1.0, std::max(usual * usual, seen) / variances_.mean());
  }
  [[nodiscard]] double longest_stick() const { return sticks_.maxCoeff(); }
  [[nodiscard]] double shortest_stick() const { return sticks_.minCoeff(); }
  [[nodiscard]] Index count() const { return sticks_.size(); }

 private:
  /// Returns the least chi2 of any line over the logarithms, by the recordings' own errors. The line through the
  /// instrument is not the one with the least chi2.
  [[nodiscard]] double least_chi2(const VectorXd& logs) const {
    const VectorXd weights = variances_.cwiseInverse();
    const double total = weights.sum();
    const VectorXd x = logs.array() - weights.dot(logs) / total;
    const VectorXd y = differences_.array() - weights.dot(differences_) / total;
    const double slope = x.cwiseProduct(weights).dot(y) / x.cwiseProduct(weights).dot(x);
    return weights.dot((y - slope * x).cwiseAbs2());
  }

  VectorXd differences_, variances_, sticks_, instrument_;
};

/// The cut-off below which this part of them lies.
double quantile_of(const AgeingCutoff& cutoff, double part) {
  double below = 0.0;
  Index i = 0;
  while (i + 1 < AgeingCutoff::kPoints && below + cutoff.weights(i) < part) below += cutoff.weights(i++);
  return cutoff.values(i);
}

/// Ageing without a cut-off is rejected: by Student's t with the recordings' own degrees of
/// freedom even where they lie on the line within their errors, since few may do so by chance.
bool is_excluded(double gain, double freedom) {
  const double least = t_quantile(freedom, 1.0 - thresholds::kCutoffChance);
  return gain > least * least;
}

/// Cut-offs whose shares have evenly spaced roots, with chi2 of their lines.
struct CutoffGrid {
  AgeingCutoff::Grid roots, values, chi2;
  double step = 0.0;

  CutoffGrid(const LinesOverSticks& lines, double lowest_root, double highest_root)
      : step((highest_root - lowest_root) / static_cast<double>(AgeingCutoff::kPoints)) {
    for (Index i = 0; i < AgeingCutoff::kPoints; ++i) {
      roots(i) = lowest_root + step * (static_cast<double>(i) + 0.5);
      values(i) = roots(i) * roots(i) / (1.0 - roots(i) * roots(i));
      chi2(i) = lines.with(values(i)).chi2;
    }
  }
  /// Returns the weights by the likelihood, where the variance of the recordings is anything between their own errors
  /// and `largest` times as much, with every logarithm as likely.
  [[nodiscard]] AgeingCutoff::Grid weights(double freedom, double largest) const {
    constexpr int kSteps = 24;
    AgeingCutoff::Grid all = AgeingCutoff::Grid::Zero();
    for (int i = 0; i < kSteps; ++i) {
      const double variance = std::pow(largest, i / (kSteps - 1.0));
      all += std::pow(variance, -0.5 * freedom) * (-0.5 * (chi2 - chi2.minCoeff()) / variance).exp();
    }
    return all / all.sum();
  }
};

/// Over the part of the range that has weight, so that its points resolve what is known.
CutoffGrid resolved_grid(const LinesOverSticks& lines, double freedom, double largest) {
  constexpr int kRefinements = 3;
  constexpr double kNothing = 1e-6;
  const double longest = lines.longest_stick();
  CutoffGrid grid(lines, 0.0, std::sqrt(longest / (1.0 + longest)));
  for (int i = 0; i < kRefinements; ++i) {
    const AgeingCutoff::Grid weights = grid.weights(freedom, largest);
    Index first = 0;
    Index last = AgeingCutoff::kPoints - 1;
    while (weights(first) < kNothing) ++first;
    while (weights(last) < kNothing) --last;
    const double lowest = grid.roots(0) - 0.5 * grid.step;
    const double highest = grid.roots(AgeingCutoff::kPoints - 1) + 0.5 * grid.step;
    grid = CutoffGrid(lines, std::max(lowest, grid.roots(first) - 1.5 * grid.step),
                      std::min(highest, grid.roots(last) + 1.5 * grid.step));
  }
  return grid;
}

AgeingCutoff cutoff_of(const LinesOverSticks& lines) {
  const double freedom = std::max(1.0, static_cast<double>(lines.count()) - 3.0);
  const double largest = lines.largest_variance();
  const CutoffGrid grid = resolved_grid(lines, freedom, largest);
  const double variance = std::max(1.0, grid.chi2.minCoeff() / freedom);
  AgeingCutoff cutoff;
  cutoff.longest = lines.longest_stick();
  cutoff.ratio = lines.longest_stick() / lines.shortest_stick();
  cutoff.values = grid.values;
  cutoff.weights = grid.weights(freedom, largest);
  const double share = (cutoff.weights * grid.roots.square()).sum();
  cutoff.value = share / (1.0 - share);
  const double gain = (lines.with(0.0).chi2 - grid.chi2.minCoeff()) / variance;
  const bool above_0 = is_excluded(gain, freedom);
  cutoff.held = {above_0 ? quantile_of(cutoff, 0.025) : 0.0, quantile_of(cutoff, 0.975)};
  cutoff.is_determined = above_0 && cutoff.ratio > thresholds::kCutoffStickRatio;
  return cutoff;
}

}  // namespace

VectorXd differences_of(const SweepSolution& solution) {
  VectorXd differences(static_cast<Index>(solution.recordings.size()));
  for (Index i = 0; i < differences.size(); ++i) {
    differences(i) = solution.recordings[static_cast<std::size_t>(i)].parameters.values(kDifference);
  }
  return differences;
}

VectorXd rises_of(const SweepSolution& solution) {
  std::vector<double> rises;
  for (std::size_t r = 0; r < solution.recordings.size(); ++r) {
    const BlockFit& recording = solution.recordings[r];
    if (!recording.solves_for(kReloadForce)) continue;
    rises.push_back(recording.parameters.values(kReloadForce) * recording.scales().force /
                    solution.population(r).force);
  }
  return Eigen::Map<const VectorXd>(rises.data(), static_cast<Index>(rises.size()));
}

VectorXd drifts_of(const SweepSolution& solution) {
  std::vector<double> drifts;
  for (const BlockFit& recording : solution.recordings) {
    if (recording.solves_for(kStiffnessDrift)) drifts.push_back(recording.parameters.values(kStiffnessDrift));
  }
  return Eigen::Map<const VectorXd>(drifts.data(), static_cast<Index>(drifts.size()));
}

AgeingLine ageing_line(const SweepSolution& solution, const AgeingCutoff& cutoff) {
  const LinesOverSticks lines(solution);
  const LinesOverSticks::Line best = lines.with(cutoff.value);
  AgeingLine line{best.difference_weights, best.rate_weights};
  const double freedom = static_cast<double>(best.residuals.size()) - 2.0;
  line.squares = std::max(best.residuals.squaredNorm(), freedom * lines.own_variances().mean());
  for (Index i = 0; i < AgeingCutoff::kPoints; ++i) {
    const LinesOverSticks::Line other = lines.with(cutoff.values(i));
    const Eigen::Vector3d move(other.difference - best.difference, other.rate - best.rate,
                               cutoff.values(i) - cutoff.value);
    line.by_cutoff += cutoff.weights(i) * move * move.transpose();
  }
  return line;
}

StaticFriction static_friction_of(const SweepSolution& solution) {
  const VectorXd differences = differences_of(solution);
  const VectorXd speeds = log_speeds(solution);
  if (solution.sweep.sharing.difference || !solution.can_show_trend()) return std::nullopt;
  const Line line = line_over(speeds, differences);
  if (!(line.slope < 0.0)) return std::nullopt;
  if (!(line.odds() > 1.0) && !within_own_errors(line.residuals, variances_of(solution))) return std::nullopt;
  return cutoff_of(LinesOverSticks(solution));
}

SpeedReach reach_of(const SweepSolution& solution) {
  const VectorXd speeds = log_speeds(solution);
  SpeedReach reach{std::exp(speeds.minCoeff()), std::exp(speeds.maxCoeff()), std::nullopt};
  if (!solution.can_show_trend()) return reach;
  if (solution.sweep.sharing.difference) {
    const double sum = (speeds.array() - speeds.mean()).square().sum();
    const double slope_error =
        std::sqrt(variances_of(solution).mean() / sum) / std::abs(differences_of(solution).mean());
    const double chance = 1.0 / (1.0 + std::sqrt(static_cast<double>(solution.cycles())));
    // The slope that would be seen by chance, and its own error, are of the same size.
    reach.trend = kNormalQuantile * std::sqrt(2.0 * chance) * slope_error;
    return reach;
  }
  const VectorXd differences = differences_of(solution);
  const Line line = line_over(speeds, differences);
  reach.trend = std::hypot(line.slope, 2.0 * line.slope_error) / std::abs(differences.mean());
  return reach;
}

}  // namespace slipfit::fit
