#include "fit/inference/profile.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "core/fit_thresholds.hpp"
#include "fit/inference/intervals.hpp"
#include "fit/problem/solve.hpp"

namespace slipfit::fit {
namespace {

constexpr double kMostDamping = 0.85;

/// A fit with zeta held: how far its sum of squares lies above the smallest, as a distance in standard errors.
struct HeldZeta {
  double zeta = 0.0;
  double distance = 0.0;
  Coordinates coordinates;
};

class Profiler {
 public:
  explicit Profiler(const DampedFit& fit) : fit_(fit), blocks_(fit.blocks) {
    best_ = fit.blocks.parameters;
    held_ = fit.held;
    held_[kDamping] = true;
    // The smallest sum of squares by the same rule as all others: a refit from it, zeta held where it is.
    smallest_ = sum_of_squares(best_.globals[kDamping]).value_or(0.0);
    const double noise = fit.uncertainty.noise / fit.blocks.scales().noise;
    variance_ = noise * noise;
  }

  std::optional<HeldZeta> at(double zeta) {
    const std::optional<double> sum = sum_of_squares(zeta);
    if (!sum) return std::nullopt;
    return HeldZeta{zeta, std::sqrt(std::max(0.0, (*sum - smallest_) / variance_)), coordinates_of(blocks_)};
  }

  /// Where the distance reaches `wanted`, between the best zeta and `limit`: secant on a distance that is nearly
  /// straight. At the limit where it does not reach it.
  std::optional<HeldZeta> reach(double wanted, double first, double limit) {
    const double best = best_.globals[kDamping];
    const double low = std::min(best, limit);
    const double high = std::max(best, limit);
    double near = best;
    double near_distance = 0.0;
    std::optional<HeldZeta> point = at(std::clamp(first, low, high));
    for (int step = 0; point && step < kMaxSteps; ++step) {
      if (std::abs(point->distance - wanted) < kClose * wanted) break;
      if (point->zeta == limit && point->distance < wanted) break;
      const double slope = (point->distance - near_distance) / (point->zeta - near);
      if (!(std::abs(slope) > 0.0)) break;
      const double next = std::clamp(point->zeta + (wanted - point->distance) / slope, low, high);
      near = point->zeta;
      near_distance = point->distance;
      if (next == near) break;
      point = at(next);
    }
    return point;
  }

 private:
  static constexpr int kMaxSteps = 5;
  static constexpr double kClose = 0.02;
  static constexpr int kIterations = 25;
  static constexpr double kTolerance = 0.01;

  std::optional<double> sum_of_squares(double zeta) {
    blocks_.parameters = best_;
    blocks_.parameters.globals[kDamping] = zeta;
    const double sum = solve(blocks_, {held_, fit_.continuous, false, kIterations, kTolerance});
    return std::isfinite(sum) ? std::optional(sum) : std::nullopt;
  }

  const DampedFit& fit_;
  BlockFit blocks_;
  Parameters best_;
  Held held_{};
  double smallest_ = 0.0;
  double variance_ = 1.0;
};

/// The distance at the upper end, where what lies below 0 is cut off: 5 % of the rest are above it.
double upper_quantile(double best, double distance_of_zero, double quantile) {
  const double signed_distance = best < 0.0 ? -distance_of_zero : distance_of_zero;
  if (signed_distance >= quantile) return quantile;
  const boost::math::normal_distribution<double> normal;
  const double above_zero = boost::math::cdf(normal, signed_distance);
  if (!(above_zero > 1e-12)) return quantile + distance_of_zero;
  return boost::math::quantile(boost::math::complement(normal, 0.05 * above_zero));
}

}  // namespace

bool needs_profile(const DampedFit& fit) {
  const Uncertainty& uncertainty = fit.uncertainty;
  if (fit.held[kDamping] || uncertainty.from_cycles || uncertainty.from_refits) return false;
  if (fit.average || fit.rival) return false;  // zeta would be profiled with the average held, and these terms alone
  return std::sqrt(std::max(0.0, uncertainty.covariance(kDamping, kDamping))) > thresholds::kWideDamping;
}

std::optional<DampingProfile> profile_damping(const DampedFit& fit, const BlockFit& centre) {
  Profiler profiler(fit);
  const double best = fit.blocks.parameters.globals[kDamping];
  const double se = std::sqrt(fit.uncertainty.covariance(kDamping, kDamping));
  const double quantile = t_quantile(fit.uncertainty.degrees_of_freedom);
  const std::optional<HeldZeta> zero = profiler.at(0.0);
  if (!zero) return std::nullopt;
  std::optional<HeldZeta> low = zero;
  if (best > 0.0 && zero->distance > quantile) low = profiler.reach(quantile, best - quantile * se, 0.0);
  const double wanted = upper_quantile(best, zero->distance, quantile);
  const std::optional<HeldZeta> high = profiler.reach(wanted, best + wanted * se, kMostDamping);
  if (!low || !high) return std::nullopt;
  const Coordinates origin = coordinates_of(centre);
  return DampingProfile{{low->zeta, high->zeta}, low->coordinates - origin, high->coordinates - origin};
}

}  // namespace slipfit::fit
