#include "fit/inference/other_laws.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace slipfit::fit {
namespace {

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

}  // namespace

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

}  // namespace slipfit::fit
