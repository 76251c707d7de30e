#include "fit/inference/intervals.hpp"

#include <algorithm>
#include <cmath>

namespace slipfit::fit {

namespace {

/// Says how far a quantity may be off to either side, both at least 0.
struct OneSided {
  double down = 0.0;
  double up = 0.0;
};
template <class Change>
OneSided one_sided(const Spread& spread, const Change& change) {
  OneSided sides;
  for (const Coordinates& move : spread.to_rivals) {
    sides.down = std::max(sides.down, -change(move));
    sides.up = std::max(sides.up, change(move));
  }
  for (const Coordinates& move : spread.one_sided) {
    sides.down += std::max(0.0, -change(move));
    sides.up += std::max(0.0, change(move));
  }
  return sides;
}

}  // namespace

CoordinateMatrix Spread::with_scatter() const {
  CoordinateMatrix whole = covariance;
  for (const Scatter& source : scatter) whole += source.covariance;
  return whole;
}

Interval damping_interval(double zeta, double se, double quantile) {
  if (zeta - quantile * se > 0.0) return {zeta - quantile * se, zeta + quantile * se};
  const double above_zero = normal_above(-zeta / se);
  if (!(above_zero > 1e-12)) return {0.0, se};
  return {0.0, zeta - se * normal_quantile(0.05 * above_zero)};
}

Interval lengthened_damping(const Interval& interval, const Spread& spread) {
  if (interval.low == interval.high) return interval;
  const OneSided sides = one_sided(spread, [](const Coordinates& move) { return move(kDamping); });
  return {std::max(0.0, interval.low - sides.down), interval.high + sides.up};
}

double Intervals::standard_error(const Jet& y) const {
  return std::sqrt(std::max(0.0, covariance(y, y)));
}

double Intervals::degrees_of_freedom(const Jet& y) const {
  double total = std::max(0.0, y.v.dot(spread_.covariance * y.v));
  double squares = total * total / spread_.degrees_of_freedom;
  bool scatters = false;
  for (const Scatter& source : spread_.scatter) {
    const double variance = std::max(0.0, y.v.dot(source.covariance * y.v));
    scatters = scatters || variance > 0.0;
    total += variance;
    squares += variance * variance / source.degrees_of_freedom;
  }
  return scatters ? total * total / squares : spread_.degrees_of_freedom;
}

Intervals::Reach Intervals::reach_of(const Jet& y, const std::function<double(const Coordinates&)>& change) const {
  const Reach own = reach_of_spread(y, change);
  const OneSided beyond = one_sided(spread_, change);
  return {own.down + beyond.down, own.up + beyond.up};
}

Intervals::Reach Intervals::reach_of_spread(const Jet& y,
                                            const std::function<double(const Coordinates&)>& change) const {
  const double quantile = this->quantile(y);
  if (!spread_.profile) return {quantile * standard_error(y), quantile * standard_error(y)};
  const Profile& profile = *spread_.profile;
  Reach reach;
  for (const Coordinates& move : profile.moves) {
    const double moved = change(move);
    reach.down = std::max(reach.down, -moved);
    reach.up = std::max(reach.up, moved);
  }
  const CoordinateMatrix scatter = covariance_ - spread_.covariance;
  const double held = quantile * std::sqrt(std::max(0.0, y.v.dot((profile.held + scatter) * y.v)));
  if (profile.at_bound) return {reach.down + held, reach.up + held};
  return {std::hypot(reach.down, held), std::hypot(reach.up, held)};
}

Intervals::Reach Intervals::reach_of(const Jet& y) const {
  return reach_of(y, [&](const Coordinates& move) { return y.v.dot(move); });
}

Estimate Intervals::estimate(const Jet& y, const Reach& reach) const {
  return {y.a, std::max(reach.down, reach.up) / quantile(y), Interval{y.a - reach.down, y.a + reach.up}, {}};
}

Estimate Intervals::interval_of(const Jet& y) const {
  return estimate(y, reach_of(y));
}

Estimate Intervals::interval_of_one_sign(const Jet& y) const {
  const Reach reach = reach_of(y);
  Estimate result = estimate(y, reach);
  const double shrink = std::exp(-(y.a > 0.0 ? reach.down : reach.up) / std::abs(y.a));
  const double grow = std::exp((y.a > 0.0 ? reach.up : reach.down) / std::abs(y.a));
  result.ci95 = Interval{std::min(y.a * shrink, y.a * grow), std::max(y.a * shrink, y.a * grow)};
  return result;
}

Estimate Intervals::interval_along(const Jet& y, const std::function<double(const Coordinates&)>& at) const {
  return estimate(y, reach_of(y, [&](const Coordinates& move) { return at(move) - y.a; }));
}

}  // namespace slipfit::fit
