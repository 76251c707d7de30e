#include "fit/inference/intervals.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <utility>

namespace slipfit::fit {

TEST_CASE("what lengthens one side of an interval is not undone by what lengthens the other") {
  Spread spread;
  spread.covariance(kReloadForce, kReloadForce) = 0.01;
  spread.degrees_of_freedom = std::numeric_limits<double>::infinity();
  spread.one_sided = {-0.5 * Coordinates::Unit(kReloadForce), -0.1 * Coordinates::Unit(kReloadForce)};
  spread.to_rivals = {0.3 * Coordinates::Unit(kReloadForce), 0.4 * Coordinates::Unit(kReloadForce)};
  const Intervals intervals(std::move(spread));
  const Jet y(2.0, static_cast<int>(kReloadForce));
  const Interval ci95 = *intervals.interval_of(y).ci95;
  const double own = 0.1 * 1.959963985;
  CHECK(ci95.low == Approx(2.0 - own - 0.6));   // two reasons add
  CHECK(ci95.high == Approx(2.0 + own + 0.4));  // of two other fits one may be right
  CHECK(intervals.whole_covariance(y, y) == Approx(0.01 + (0.25 + 0.01 + 0.09 + 0.16) / 3.0));
}

TEST_CASE("few recordings widen the intervals only of what scatters between them") {
  Spread spread;
  spread.covariance(kLogStiffness, kLogStiffness) = 0.01;
  spread.covariance(kDifference, kDifference) = 0.01;
  spread.degrees_of_freedom = std::numeric_limits<double>::infinity();
  Scatter scatter{CoordinateMatrix::Zero(), 1.0};
  scatter.covariance(kDifference, kDifference) = 0.03;
  spread.scatter = {scatter};
  const Intervals intervals(std::move(spread));
  const Jet stiffness(1.0, static_cast<int>(kLogStiffness));
  const Jet difference(1.0, static_cast<int>(kDifference));
  CHECK(intervals.interval_of(stiffness).ci95->high == Approx(1.0 + 0.1 * 1.959963985));
  CHECK(intervals.degrees_of_freedom(difference) == Approx(0.04 * 0.04 / (0.03 * 0.03)));  // Satterthwaite
  CHECK(intervals.standard_error(difference) == Approx(0.2));
}

}  // namespace slipfit::fit
