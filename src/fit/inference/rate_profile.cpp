#include "fit/inference/rate_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "core/parallel.hpp"
#include "fit/inference/covariance.hpp"
#include "fit/inference/intervals.hpp"
#include "fit/selection/sweep_solution.hpp"

namespace slipfit::fit {
namespace {

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

}  // namespace

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

}  // namespace slipfit::fit
