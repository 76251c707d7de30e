#include "fit/inference/intervals.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace slipfit::fit {

Interval damping_interval(double zeta, double se, double quantile) {
  if (zeta - quantile * se > 0.0) return {zeta - quantile * se, zeta + quantile * se};
  const boost::math::normal_distribution<double> normal(zeta, se);
  const double above_zero = boost::math::cdf(boost::math::complement(normal, 0.0));
  if (!(above_zero > 1e-12)) return {0.0, se};
  return {0.0, boost::math::quantile(boost::math::complement(normal, 0.05 * above_zero))};
}

double Intervals::standard_error(const Jet& y) const {
  return std::sqrt(std::max(0.0, covariance(y, y)));
}

double Intervals::degrees_of_freedom(const Jet& y) const {
  const double fitted = std::max(0.0, y.v.dot(spread_.covariance * y.v));
  const double scatter = std::max(0.0, y.v.dot(spread_.scatter * y.v));
  if (!(scatter > 0.0)) return spread_.degrees_of_freedom;
  const double total = fitted + scatter;
  return total * total /
         (fitted * fitted / spread_.degrees_of_freedom + scatter * scatter / spread_.scatter_degrees_of_freedom);
}

Intervals::Reach Intervals::reach_of(const Jet& y, const std::function<double(const Coordinates&)>& change) const {
  const double off = change(spread_.one_sided);
  const Reach reach = reach_of_spread(y, change);
  return {reach.down + std::max(0.0, -off), reach.up + std::max(0.0, off)};
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
  const double held = quantile * std::sqrt(std::max(0.0, y.v.dot((profile.held + spread_.scatter) * y.v)));
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
