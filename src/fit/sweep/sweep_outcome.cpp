#include "fit/sweep/sweep_outcome.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "core/thresholds.hpp"
#include "fit/inference/covariance.hpp"
#include "fit/inference/intervals.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/inference/uncertainty.hpp"
#include "fit/selection/solution.hpp"
#include "fit/sweep/ageing_line.hpp"
#include "fit/sweep/sweep_solution.hpp"

namespace slipfit::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// One value a recording, or one that they share.
VectorXd shared_or_own(const VectorXd& of_recordings, bool shared) {
  return shared ? VectorXd(of_recordings.head(1)) : of_recordings;
}

VectorXd levels_of(const SweepSolution& solution) {
  VectorXd levels(static_cast<Index>(solution.recordings.size()));
  for (Index r = 0; r < levels.size(); ++r) {
    levels(r) = solution.recordings[static_cast<std::size_t>(r)].parameters.level[0];
  }
  return shared_or_own(levels, solution.sweep.sharing.level);
}

/// The variance of one recording's own value.
struct OwnVariance {
  double value = 0.0;
  double degrees_of_freedom = 1.0;

  [[nodiscard]] double half_width() const { return t_quantile(degrees_of_freedom) * std::sqrt(value); }
};

/// Returns the variance by the sum of squares around a mean or a line, or with what is known of friction beforehand
/// where the interval is narrower with it: two or three recordings alone allow nearly any scatter.
OwnVariance own_variance(double squares, double freedom, double usual_value) {
  constexpr double kWorth = 2.0;  // recordings that the knowledge counts as
  const double usual = thresholds::kUsualScatter * usual_value;
  const OwnVariance with_usual{(squares + kWorth * usual * usual) / (freedom + kWorth), freedom + kWorth};
  if (freedom < 1.0) return with_usual;
  const OwnVariance alone{squares / freedom, freedom};
  return alone.half_width() < with_usual.half_width() ? alone : with_usual;
}

double squares_around_mean(const VectorXd& values) {
  return (values.array() - values.mean()).square().sum();
}

/// Adds the scatter of the mean of what the recordings have each for themselves.
void add_scatter_of_mean(Spread& spread, Coordinate coordinate, const VectorXd& values, double usual_value) {
  if (values.size() < 2) return;
  const auto count = static_cast<double>(values.size());
  const OwnVariance own = own_variance(squares_around_mean(values), count - 1.0, usual_value);
  Scatter scatter{CoordinateMatrix::Zero(), own.degrees_of_freedom};
  scatter.covariance(coordinate, coordinate) = own.value / count;
  spread.scatter.push_back(scatter);
}

/// Returns the line of static friction: without ageing it is level, at the mean.
AgeingLine static_friction_line(const SweepSolution& solution, const StaticFriction& kind) {
  if (kind) return ageing_line(solution, *kind);
  const VectorXd differences = shared_or_own(differences_of(solution), solution.sweep.sharing.difference);
  const Index count = differences.size();
  return {VectorXd::Constant(count, 1.0 / static_cast<double>(count)), VectorXd::Zero(count),
          squares_around_mean(differences)};
}

Selection selection_of(const SweepSolution& solution, const AgeingLine& line) {
  const CommonColumns columns(solution.problem());
  Selection selection{MatrixXd::Zero(columns.size(), kCoordinates), {}};
  for (std::size_t r = 0; r < solution.recordings.size(); ++r) {
    for (const Coordinate coordinate : solution.recordings[r].columns().coordinates()) {
      if (!is_of_recording(coordinate)) selection.common(*columns.find(r, coordinate), coordinate) = 1.0;
    }
  }
  const Index levels = levels_of(solution).size();
  for (Index r = 0; r < levels; ++r) {
    selection.common(columns.level(static_cast<std::size_t>(r)), kLevel) = 1.0 / static_cast<double>(levels);
  }
  for (Index r = 0; r < line.rate_weights.size(); ++r) {
    const Index column = *columns.find(static_cast<std::size_t>(r), kDifference);
    selection.common(column, kDifference) = line.difference_weights(r);
    selection.common(column, kAgeing) = line.rate_weights(r);
  }
  const auto rises = static_cast<double>(rises_of(solution).size());
  const auto drifts = static_cast<double>(drifts_of(solution).size());
  for (std::size_t r = 0; r < solution.recordings.size(); ++r) {
    const std::optional<Index> rise = columns.find(r, kReloadForce);
    const double unit = solution.recordings[r].scales().force / solution.population(r).force;
    if (rise) selection.common(*rise, kReloadForce) = unit / rises;
    const std::optional<Index> drift = columns.find(r, kStiffnessDrift);
    if (drift) selection.common(*drift, kStiffnessDrift) = 1.0 / drifts;
  }
  return selection;
}

/// Adds the scatter of the recordings' own static friction around their line.
void add_scatter_around(const AgeingLine& line, double difference, const StaticFriction& kind, Spread& spread) {
  if (line.rate_weights.size() < 2) return;
  MatrixXd weights(line.rate_weights.size(), 2);
  weights << line.difference_weights, line.rate_weights;
  const double fitted = kind ? 2.0 : 1.0;
  const OwnVariance own = own_variance(line.squares, static_cast<double>(weights.rows()) - fitted, difference);
  Scatter scatter{CoordinateMatrix::Zero(), own.degrees_of_freedom};
  scatter.covariance.block<2, 2>(kDifference, kDifference) = own.value * weights.transpose() * weights;
  spread.scatter.push_back(scatter);
}

}  // namespace

Coordinates coordinates_of(const SweepSolution& solution, const StaticFriction& kind) {
  const AgeingLine line = static_friction_line(solution, kind);
  const VectorXd differences = shared_or_own(differences_of(solution), solution.sweep.sharing.difference);
  Coordinates values = solution.shared();
  values(kLevel) = levels_of(solution).mean();
  values(kDifference) = line.difference_weights.dot(differences);
  values(kAgeing) = line.rate_weights.dot(differences);
  values(kAgeingTime) = kind ? kind->value : 0.0;
  if (const VectorXd rises = rises_of(solution); rises.size() > 0) values(kReloadForce) = rises.mean();
  if (const VectorXd drifts = drifts_of(solution); drifts.size() > 0) values(kStiffnessDrift) = drifts.mean();
  return values;
}

Spread spread_of(const SweepData& data, const SweepSolution& solution, const std::vector<Normal>& normals,
                 const StaticFriction& kind) {
  const Problem problem = solution.problem();
  const AgeingLine line = static_friction_line(solution, kind);
  const Selection selection = selection_of(solution, line);
  const bool correlated = std::any_of(data.fitted.begin(), data.fitted.end(),
                                      [&](std::size_t i) { return data.single[i]->uncertainty.from_cycles; });
  Spread spread;
  if (correlated) {
    spread.covariance = jackknife_covariance(problem, normals, selection, solution.held);
    spread.degrees_of_freedom = std::max(1.0, static_cast<double>(normals.size()) - 1.0);
  } else {
    const double variance = std::max(1.0, solution.chi2 / solution.degrees_of_freedom);
    spread.covariance = variance * white_covariance(problem, normals, selection, {solution.held});
    spread.degrees_of_freedom = static_cast<double>(solution.cycles());
  }
  const VectorXd levels = levels_of(solution);
  const VectorXd rises = rises_of(solution);
  add_scatter_of_mean(spread, kLevel, levels, levels.mean());
  if (rises.size() > 0) add_scatter_of_mean(spread, kReloadForce, rises, rises.mean());
  add_scatter_of_mean(spread, kStiffnessDrift, drifts_of(solution), 1.0);  // of ln k
  add_scatter_around(line, differences_of(solution).mean(), kind, spread);
  return spread;
}

Coordinates with_damping_cut(const Coordinates& values, const Spread& spread) {
  const CoordinateMatrix covariance = spread.with_scatter();
  const double variance = covariance(kDamping, kDamping);
  if (!(values(kDamping) < 0.0) || !(variance > 0.0)) return values;
  Coordinates cut = values - covariance.col(kDamping) * (values(kDamping) / variance);
  cut(kDamping) = 0.0;
  return cut;
}

namespace {

/// Adds the uncertainty of the cut-off of ageing, whose distribution is known.
void add_cutoff(const SweepSolution& solution, const StaticFriction& kind, Spread& spread) {
  if (!kind) return;
  Scatter scatter{CoordinateMatrix::Zero(), std::numeric_limits<double>::infinity()};
  scatter.covariance.block<3, 3>(kDifference, kDifference) = ageing_line(solution, *kind).by_cutoff;
  spread.scatter.push_back(scatter);
}

constexpr std::array kRates{kLeastRate, -7.0, -5.0, -3.5, -2.5, -1.8, -1.3, -0.9,
                            -0.6,       -0.3, 0.01, 0.3,  0.6,  1.0,  1.5,  kMostRate};

/// Says where the coordinates are with alpha held.
struct Point {
  Coordinates move;   ///< from the best ones
  double root = 0.0;  ///< of the rise in the sum of squares, in standard errors
};

/// Rates below or above the best one, the nearest first.
std::vector<double> rates_around(double best, double side) {
  std::vector<double> rates;
  for (const double rate : kRates) {
    if ((rate - best) * side > 0.0) rates.push_back(rate);
  }
  if (side < 0.0) std::reverse(rates.begin(), rates.end());
  return rates;
}

/// Returns the moves of the values on one side, as long as the sum of squares has risen by less than the square of the
/// quantile, and at the point at which it passes that.
std::vector<Point> points_on(const SweepSolution& solution, const StaticFriction& kind, const Coordinates& best,
                             double quantile, double side) {
  const double variance = std::max(1.0, solution.chi2 / solution.degrees_of_freedom);
  std::vector<Point> points;
  Point before{Coordinates::Zero(), 0.0};
  const SweepSolution* from = &solution;
  std::optional<SweepSolution> held;
  for (const double rate : rates_around(best(kFrictionRate), side)) {
    std::optional<SweepSolution> next = with_rate(*from, rate);
    if (!next) break;
    const double root = std::sqrt(std::max(0.0, next->chi2 - solution.chi2) / variance);
    const Coordinates move = coordinates_of(*next, kind) - best;
    if ((before.root <= quantile) != (root <= quantile)) {
      const double share = (quantile - before.root) / (root - before.root);
      points.push_back({before.move + share * (move - before.move), quantile});
    }
    before = {move, root};
    if (root <= quantile) points.push_back(before);
    held = std::move(next);
    from = &*held;
  }
  return points;
}

/// Inside the interval of alpha, the nearest first.
struct Sides {
  std::vector<Point> lower, higher;
};

/// Moves `best` to the best point with zeta >= 0 where the best zeta is negative, and lets the sides lead from there to
/// the others of these. Does nothing where no point has zeta >= 0.
void avoid_negative_damping(Coordinates& best, Sides& sides) {
  if (!(best(kDamping) < 0.0)) return;
  std::vector<Point> physical;
  for (const auto* side : {&sides.lower, &sides.higher}) {
    for (const Point& point : *side) {
      if (best(kDamping) + point.move(kDamping) >= 0.0) physical.push_back(point);
    }
  }
  if (physical.empty()) return;
  const auto by_rate = [](const auto& a, const auto& b) { return a.move(kFrictionRate) < b.move(kFrictionRate); };
  const auto by_root = [](const auto& a, const auto& b) { return a.root < b.root; };
  std::sort(physical.begin(), physical.end(), by_rate);
  const auto nearest = std::min_element(physical.begin(), physical.end(), by_root);
  const Coordinates to_nearest = nearest->move;
  for (Point& point : physical) point.move -= to_nearest;
  best += to_nearest;
  sides = {{std::make_reverse_iterator(nearest), physical.rend()}, {nearest + 1, physical.end()}};
}

/// Holds the best coordinates and their spread along alpha. If alpha is known badly the sum of squares is no parabola
/// along it: alpha times zeta is known better than either, and a second minimum may have the other sign. The spread is
/// then from refits with alpha held, out to where the sum of squares has risen by the square of Student's quantile, and
/// from what `spread` says. Where alpha is known well, or held, it is from `spread` alone. `best` is the solution's
/// coordinates. A negative zeta is moved to the best of the profile with zeta >= 0, and the profile leads from there to
/// the others of these.
struct AlongRate {
  Coordinates best;
  Spread spread;
};
AlongRate profile_rate(const SweepSolution& solution, const StaticFriction& kind, const Coordinates& best,
                       const Spread& spread) {
  AlongRate result{best, spread};
  const double variance = spread.covariance(kFrictionRate, kFrictionRate);
  if (!(variance > 0.0)) return result;
  const double quantile = t_quantile(spread.degrees_of_freedom);
  Sides sides;
  if (!solution.held[kFrictionRate] && std::sqrt(variance) >= thresholds::kKnownRate * std::abs(best(kFrictionRate))) {
    const auto side_of = [&](std::size_t i) { return points_on(solution, kind, best, quantile, i == 0 ? -1.0 : 1.0); };
    std::vector<std::vector<Point>> both = in_parallel(2, side_of);
    sides = {std::move(both[0]), std::move(both[1])};
    avoid_negative_damping(result.best, sides);
  }
  Profile profile{given(spread.covariance, kFrictionRate), {}, false};
  CoordinateMatrix by_profile = CoordinateMatrix::Zero();
  for (const auto* side : {&sides.lower, &sides.higher}) {
    if (side->empty()) continue;
    const Coordinates end = side->back().move / quantile;
    by_profile += 0.5 * end * end.transpose();
    for (const Point& point : *side) profile.moves.push_back(point.move);
  }
  const Coordinates along = spread.covariance.col(kFrictionRate) / std::sqrt(variance);
  for (const double side : {-quantile, quantile}) profile.moves.emplace_back(side * along);
  if (by_profile(kFrictionRate, kFrictionRate) > variance) result.spread.covariance = profile.held + by_profile;
  result.spread.profile = std::move(profile);
  return result;
}

/// alpha v_c of the logarithmic law: friction that goes on changing below the slowest sliding that a slip shows.
constexpr std::array kEarlierRates{-3.0, -10.0, -30.0, -100.0, -300.0};

/// A law is excluded if the sum of squares rises by more than this, in variances of the residuals: chi^2 of one degree
/// of freedom at 95 %.
constexpr double kExcluding = 3.841458821;

/// Limits alpha v_c of the hyperbolic law. Below it the law is Coulomb friction with a spike at rest, which no slip
/// shows.
constexpr double kSteepest = -20.0;

double rate_of(const SweepSolution& solution) {
  return solution.recordings.front().parameters.values(kFrictionRate);
}

/// The hyperbolic law, and the logarithmic one at its best and at rates that begin to change the friction ever earlier.
std::vector<SweepSolution> other_solutions(const SweepSolution& exponential, double highest) {
  std::vector<SweepSolution> solutions;
  const auto keep = [&](std::optional<SweepSolution> solution) {
    const bool is_possible = solution && solution->chi2 < highest;
    if (is_possible) solutions.push_back(*std::move(solution));
    return is_possible;
  };
  std::optional<SweepSolution> hyperbolic = with_law(exponential, FrictionLaw::Hyperbolic);
  if (hyperbolic && rate_of(*hyperbolic) > kSteepest) keep(std::move(hyperbolic));
  std::optional<SweepSolution> logarithmic = with_law(exponential, FrictionLaw::Logarithmic);
  if (!logarithmic) return solutions;
  const double best_rate = rate_of(*logarithmic);
  SweepSolution from = *logarithmic;
  keep(std::move(logarithmic));
  for (const double rate : kEarlierRates) {
    if (rate >= best_rate) continue;
    if (!keep(with_rate(from, rate))) break;
    from = solutions.back();
  }
  return solutions;
}

/// Returns the one with the largest move of the hyperbolic and the logarithmic laws that the recordings do not exclude.
/// The result is empty where they exclude all.
std::optional<OtherLaw> other_law(const SweepSolution& exponential, const StaticFriction& kind) {
  const double variance = std::max(1.0, exponential.chi2 / exponential.degrees_of_freedom);
  const Coordinates values = coordinates_of(exponential, kind);
  std::optional<OtherLaw> furthest;
  for (const SweepSolution& solution : other_solutions(exponential, exponential.chi2 + kExcluding * variance)) {
    const Coordinates others = coordinates_of(solution, kind);
    OtherLaw other{solution.recordings.front().scales().law, others(kDifference), Coordinates::Zero()};
    for (const auto i : {kLevel, kDifference}) other.move(i) = others(i) - values(i);
    if (!furthest || std::abs(other.move(kDifference)) > std::abs(furthest->move(kDifference))) furthest = other;
  }
  return furthest;
}

LeftOut fit_of(const SweepData& data, const NormalSolution& fit, const StaticFriction& kind) {
  return {coordinates_of(fit.solution, kind), spread_of(data, fit.solution, fit.normals, kind), reach_of(fit.solution)};
}

std::vector<std::optional<LeftOut>> leave_out_each(const SweepData& data, const NormalSolution& all,
                                                   const StaticFriction& kind) {
  const std::size_t count = all.solution.recordings.size();
  Notifier notify(data.notify_step);
  return in_parallel(count, [&](std::size_t recording) -> std::optional<LeftOut> {
    notify(fmt::format("fitting without recording {} of {}", recording + 1, count));
    const std::optional<NormalSolution> others = leave_out(all, recording);
    if (!others) return std::nullopt;
    LeftOut one = fit_of(data, *others, kind);
    add_cutoff(others->solution, kind, one.spread);
    return one;
  });
}

double count_of(const std::vector<std::optional<LeftOut>>& each) {
  return static_cast<double>(std::count_if(each.begin(), each.end(), [](const auto& one) { return one.has_value(); }));
}

/// Delete-one-recording jackknife.
CoordinateMatrix jackknife_over(const std::vector<std::optional<LeftOut>>& each) {
  const double count = count_of(each);
  Coordinates mean = Coordinates::Zero();
  for (const auto& one : each) {
    if (one) mean += one->values / count;
  }
  CoordinateMatrix sum = CoordinateMatrix::Zero();
  for (const auto& one : each) {
    if (one) sum += (count - 1.0) / count * (one->values - mean) * (one->values - mean).transpose();
  }
  return sum;
}

/// Returns the variances that fewer data would enlarge: by cycles and recordings.
Coordinates sampling_variances(const Spread& spread) {
  Coordinates variances = spread.covariance.diagonal();
  for (const Scatter& source : spread.scatter) {
    if (std::isfinite(source.degrees_of_freedom)) variances += source.covariance.diagonal();
  }
  return variances;
}

/// The recordings disagree by more than noise and the scatter of the cycles explain: the variance of the shift between
/// an efficient estimate and one from fewer data is the difference of their variances (Hausman).
bool recordings_disagree(const SweepOutcome& outcome) {
  if (count_of(outcome.left_out) < 3.0) return false;
  const Coordinates all = sampling_variances(outcome.spread);
  for (const auto& one : outcome.left_out) {
    if (!one) continue;
    const Coordinates without = sampling_variances(one->spread);
    for (Eigen::Index i = 0; i < kCoordinates; ++i) {
      const double least = 0.05 * all(i);  // rounding and iteration: the difference may come out as nothing
      const double variance = std::max(without(i) - all(i), least);
      const double shift = one->values(i) - outcome.values(i);
      if (variance > 0.0 && shift * shift > thresholds::kOfManySigmas * thresholds::kOfManySigmas * variance)
        return true;
    }
  }
  return false;
}

/// ln of the spacing predicted without a recording over its own; empty where there is no prediction.
std::optional<double> left_out_difference(const SweepOutcome& outcome, std::size_t recording) {
  const std::optional<LeftOut>& one = outcome.left_out[recording];
  if (!one) return std::nullopt;
  const SweepSolution& solution = outcome.solution;
  const BlockFit& blocks = solution.recordings[recording];
  const double speed = blocks.scales().speed_m_per_s;
  const SlidingModel model(with_damping_cut(one->values, one->spread), solution.sweep.units);
  const auto spacing = model.spacing(speed, solution.population(recording).load);
  if (!spacing) return std::nullopt;
  return std::log(spacing->a / (speed * median_period_s(blocks)));
}

/// Returns the largest error of predictions of a recording at an end of the speeds by the others, per factor of e
/// outside their speeds: whatever the law lacks shows there first.
double error_beyond(const SweepOutcome& outcome) {
  double largest = 0.0;
  for (std::size_t recording = 0; recording < outcome.left_out.size(); ++recording) {
    const std::optional<double> difference = left_out_difference(outcome, recording);
    if (!difference) continue;
    const double speed = outcome.solution.recordings[recording].scales().speed_m_per_s;
    const double distance = outcome.left_out[recording]->reach.distance_to(speed);
    if (distance > thresholds::kBeyondDistance) largest = std::max(largest, std::abs(*difference) / distance);
  }
  return largest;
}

/// Returns the move of the coordinates of `outcome` per unit of one that is held.
std::optional<Coordinates> moves_by(Coordinate coordinate, const SweepSolution& solution, const SweepOutcome& outcome) {
  constexpr double kMove = 0.01;  // of ln w_n or zeta
  const std::optional<SweepSolution> other = with_held(solution, coordinate, kMove);
  if (!other) return std::nullopt;
  return (coordinates_of(*other, outcome.static_friction) - outcome.values) / kMove;
}

/// Returns the covariance with the errors of w_n and zeta, which `outcome` holds at the values by ring-downs or by a
/// stated mass alone.
CoordinateMatrix with_errors_of_held(const SweepData& data, const SweepSolution& solution,
                                     const SweepOutcome& outcome) {
  const CoordinateMatrix& held = outcome.spread.covariance;
  const std::optional<Coordinates> by_frequency = moves_by(kLogFrequency, solution, outcome);
  if (!by_frequency) return held;
  if (!data.motion) return with_mass(held, *by_frequency, data.mass->relative_error);
  const std::optional<Coordinates> by_damping = moves_by(kDamping, solution, outcome);
  if (!by_damping) return held;
  MotionMoves moves;
  moves << *by_frequency, *by_damping;
  return with_motion(held, moves, *data.motion);
}

}  // namespace

SweepOutcome with_left_out(const SweepData& data, const SweepSolution& solution) {
  const StaticFriction kind = static_friction_of(solution);
  const NormalSolution normal{solution, normals_of(solution.problem())};
  LeftOut all = fit_of(data, normal, kind);
  return {solution, kind, all.values, std::move(all.spread), all.reach, leave_out_each(data, normal, kind)};
}

namespace {

/// Adds what intervals need besides: other laws of kinetic friction, recordings that disagree, the profile of alpha.
SweepOutcome with_intervals(const SweepData& data, SweepOutcome outcome) {
  const SweepSolution& solution = outcome.solution;
  Spread& spread = outcome.spread;
  if (const BlockFit* averaged = solution.with_sensor_time()) {
    spread.covariance = with_unknown_shape(spread.covariance, *averaged);
  }
  if (data.mass || data.motion) spread.covariance = with_errors_of_held(data, solution, outcome);
  if (depends_on_speed(solution.recordings.front().scales().law)) {
    outcome.other_law = other_law(solution, outcome.static_friction);
  }
  outcome.disagree = recordings_disagree(outcome);
  if (outcome.disagree) {
    const double fitted =
        solution.recordings.front().solves_for(kStiffnessExponent) ? 2.0 : 1.0;  // of a line, of a mean
    spread.scatter.push_back({jackknife_over(outcome.left_out), std::max(1.0, count_of(outcome.left_out) - fitted)});
  }
  if (outcome.reach.trend) outcome.reach.trend = std::hypot(*outcome.reach.trend, error_beyond(outcome));
  add_cutoff(solution, outcome.static_friction, spread);
  AlongRate along = profile_rate(solution, outcome.static_friction, outcome.values, spread);
  outcome.values = along.best;
  spread = std::move(along.spread);
  return outcome;
}

}  // namespace

SweepOutcome outcome_of(const SweepData& data, const SweepSolution& solution) {
  return with_intervals(data, with_left_out(data, solution));
}

Spread spread_at(const LeftOut& fit, double speed_m_per_s) {
  Spread spread = fit.spread;
  Coordinates trend = Coordinates::Zero();
  trend(kDifference) = fit.reach.half_width_at(speed_m_per_s) * fit.values(kDifference);
  Coordinates growth = Coordinates::Zero();
  growth(kLogStiffness) = fit.values(kStiffnessExponent) * fit.reach.distance_beyond(speed_m_per_s);
  growth(kLogFrequency) = 0.5 * growth(kLogStiffness);  // of the same mass
  for (const Coordinates& half_width : {trend, growth}) {
    const Coordinates error = half_width / kNormalQuantile;
    spread.scatter.push_back({error * error.transpose(), std::numeric_limits<double>::infinity()});
  }
  return spread;
}

double left_out_error(const SweepOutcome& outcome) {
  const SweepSolution& solution = outcome.solution;
  double square = 0.0;
  for (std::size_t recording = 0; recording < solution.recordings.size(); ++recording) {
    const double most = std::log(thresholds::kWidestFactor);
    const double error = std::min(most, std::abs(left_out_difference(outcome, recording).value_or(most)));
    square += error * error;
  }
  return std::sqrt(square / static_cast<double>(solution.recordings.size()));
}

double residual_over_noise(std::span<const SweepRecording> recordings, const SweepData& data,
                           const SweepSolution& solution) {
  std::vector<double> squares;
  for (const std::size_t i : data.fitted) {
    const double noise = recordings[i].quality.noise_rms;
    if (noise > 0.0) squares.push_back(std::pow(data.single[i]->uncertainty.noise / noise, 2));
  }
  if (squares.empty()) return 0.0;
  return slipfit::mean_of(squares) * solution.chi2 / solution.degrees_of_freedom;
}

double effect_of_averaging(std::span<const SweepRecording> recordings, const SweepOutcome& outcome,
                           const SweepData& data) {
  const double omega = std::exp(outcome.values(kLogFrequency));
  double variance_s2 = 0.0;
  for (const std::size_t i : data.fitted) {
    const Recording& recording = recordings[i].recording;
    if (recording.conditions().sensor_average_s || data.single[i]->average) continue;
    const double step_s = recording.sample_interval_s();
    variance_s2 += data.rounding_s2.value_or(step_s * step_s / 12.0) / static_cast<double>(data.fitted.size());
  }
  return kFrequencyByAverage * omega * omega * variance_s2;
}

}  // namespace slipfit::fit
