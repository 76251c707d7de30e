#include "fit/inference/joint_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "fit/inference/intervals.hpp"

namespace slipfit::fit {
namespace {

/// Standard error over value of alpha from which on its profile is worth the refits.
constexpr double kKnownWell = 0.15;
/// alpha v_c; friction that falls by more than exp(-10) over a slip, or grows by more than exp(2), is another law.
constexpr std::array kRates{-10.0, -7.0, -5.0, -3.5, -2.5, -1.8, -1.3, -0.9, -0.6, -0.3, 0.01, 0.3, 0.6, 1.0, 1.5, 2.0};

/// Rates below or above the best one, the nearest first.
std::vector<double> rates_beside(double best, double side) {
  std::vector<double> rates;
  for (const double rate : kRates) {
    if ((rate - best) * side > 0.0) rates.push_back(rate);
  }
  if (side < 0.0) std::reverse(rates.begin(), rates.end());
  return rates;
}

/// How far the values move on one side, as long as the sum of squares has risen by less than the square of the
/// quantile, and where it passes that.
std::vector<RateProfile::Point> points_on(const SweepData& data, const JointSolution& solution, StaticFriction kind,
                                          const SweepVector& best, double quantile, double side) {
  const double variance = std::max(1.0, solution.chi2 / solution.degrees_of_freedom);
  std::vector<RateProfile::Point> points;
  RateProfile::Point before{SweepVector::Zero(), 0.0};
  const JointSolution* from = &solution;
  std::optional<JointSolution> held;
  for (const double rate : rates_beside(best(kFrictionRate), side)) {
    std::optional<JointSolution> next = with_rate(data, *from, rate);
    if (!next) break;
    const double root = std::sqrt(std::max(0.0, next->chi2 - solution.chi2) / variance);
    const SweepVector move = sweep_values(*next, kind) - best;
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

}  // namespace

RateProfile profile_of_rate(const SweepData& data, const JointSolution& solution, StaticFriction kind,
                            const SweepVector& best, const SweepMatrix& covariance, double degrees_of_freedom) {
  const double error = std::sqrt(covariance(kFrictionRate, kFrictionRate));
  if (solution.held[kFrictionRate] || error < kKnownWell * std::abs(best(kFrictionRate))) return {};
  const double quantile = t_quantile(degrees_of_freedom);
  return {points_on(data, solution, kind, best, quantile, -1.0), points_on(data, solution, kind, best, quantile, 1.0)};
}

void avoid_negative_damping(SweepVector& values, RateProfile& profile) {
  if (!(values(kJointDamping) < 0.0)) return;
  std::vector<RateProfile::Point> physical;
  for (const auto* side : {&profile.lower, &profile.higher}) {
    for (const RateProfile::Point& point : *side) {
      if (values(kJointDamping) + point.move(kJointDamping) >= 0.0) physical.push_back(point);
    }
  }
  if (physical.empty()) return;
  const auto by_rate = [](const auto& a, const auto& b) { return a.move(kFrictionRate) < b.move(kFrictionRate); };
  const auto by_root = [](const auto& a, const auto& b) { return a.root < b.root; };
  std::sort(physical.begin(), physical.end(), by_rate);
  const auto best = std::min_element(physical.begin(), physical.end(), by_root);
  const SweepVector to_best = best->move;
  for (RateProfile::Point& point : physical) point.move -= to_best;
  values += to_best;
  profile = {{std::make_reverse_iterator(best), physical.rend()}, {best + 1, physical.end()}};
}

}  // namespace slipfit::fit
