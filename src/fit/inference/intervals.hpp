#pragma once

#include <ceres/jet.h>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "core/statistics.hpp"
#include "fit/coordinates.hpp"
#include "slipfit/core/estimate.hpp"

namespace slipfit::fit {

/// zeta cannot be negative: the part of the estimate's distribution below 0 is cut off. Where 0 is inside the interval,
/// the upper end leaves 5 % of the rest above it.
Interval damping_interval(double zeta, double se, double quantile);

/// A number that knows its derivatives with respect to the coordinates.
using Jet = ceres::Jet<double, kCoordinates>;

/// Holds the moves of all coordinates while one of them runs through its 95 % interval. A profile is needed where the
/// sum of squares is no parabola along that coordinate.
struct Profile {
  CoordinateMatrix held;           ///< covariance with that coordinate held
  std::vector<Coordinates> moves;  ///< from the best values; the farthest ones are at the ends of the interval
  /// At a bound every value of the interval is as good as the next: what is left with it held adds in full. Elsewhere
  /// the ends of the interval are as unlikely as those of the rest, and both add as squares.
  bool at_bound = false;
};

/// A covariance that was estimated from few cycles or recordings.
struct Scatter {
  CoordinateMatrix covariance;
  double degrees_of_freedom = 1.0;  ///< infinite where the covariance is known
};

/// Holds what is known of the uncertainty of the coordinates.
struct Spread {
  CoordinateMatrix covariance = CoordinateMatrix::Zero();
  double degrees_of_freedom = 1.0;
  std::vector<Scatter> scatter{};  ///< to be added to the covariance
  std::optional<Profile> profile;
  /// Holds how far the coordinates are off at most, in full or in part, for reasons that no refit shows. Each entry
  /// lengthens one side of an interval.
  std::vector<Coordinates> one_sided{};
  /// The way to each of other fits of which one may be right: the farthest lengthens its side of an interval.
  std::vector<Coordinates> to_rivals{};

  /// Returns the covariance with all scatter.
  [[nodiscard]] CoordinateMatrix with_scatter() const;
};

/// An interval of zeta (of no width: held) with the sides longer by what lengthens those of others.
Interval lengthened_damping(const Interval& interval, const Spread& spread);

/// The 95 % interval of any function of the coordinates, the one place where intervals are made: Student's t with the
/// degrees of freedom of fit and scatter (Satterthwaite), along a profile where there is one, one side longer by
/// Spread::one_sided and to_rivals. Where it is not symmetric, the standard error is that of the longer side.
class Intervals {
 public:
  explicit Intervals(Spread spread) : spread_(std::move(spread)), covariance_(spread_.with_scatter()) {}

  [[nodiscard]] Estimate interval_of(const Jet& y) const;
  /// Symmetric in the logarithm: the sign is known.
  [[nodiscard]] Estimate interval_of_one_sign(const Jet& y) const;
  /// Returns the interval of a quantity that bends over the profile. `at` gives its value where the coordinates have
  /// moved.
  [[nodiscard]] Estimate interval_along(const Jet& y, const std::function<double(const Coordinates&)>& at) const;

  [[nodiscard]] double covariance(const Jet& a, const Jet& b) const { return a.v.dot(covariance_ * b.v); }
  /// Includes what lengthens one side: anything up to it is as likely, which adds a third of its square.
  [[nodiscard]] double whole_covariance(const Jet& a, const Jet& b) const {
    double whole = covariance(a, b);
    for (const auto* moves : {&spread_.one_sided, &spread_.to_rivals}) {
      for (const Coordinates& move : *moves) whole += a.v.dot(move) * b.v.dot(move) / 3.0;
    }
    return whole;
  }
  /// Returns the standard error by the covariance.
  [[nodiscard]] double standard_error(const Jet& y) const;
  /// Returns the degrees of freedom of Student's t, from those of fit and scatter (Satterthwaite).
  [[nodiscard]] double degrees_of_freedom(const Jet& y) const;
  [[nodiscard]] double quantile(const Jet& y) const { return t_quantile(degrees_of_freedom(y)); }
  [[nodiscard]] const Spread& spread() const { return spread_; }

 private:
  /// Says how far a quantity extends below and above its value, both at least 0.
  struct Reach {
    double down = 0.0;
    double up = 0.0;
  };
  [[nodiscard]] Reach reach_of(const Jet& y, const std::function<double(const Coordinates&)>& change) const;
  [[nodiscard]] Reach reach_of(const Jet& y) const;
  /// Returns the reach without what lengthens one side.
  [[nodiscard]] Reach reach_of_spread(const Jet& y, const std::function<double(const Coordinates&)>& change) const;
  [[nodiscard]] Estimate estimate(const Jet& y, const Reach& reach) const;

  Spread spread_;
  CoordinateMatrix covariance_;  ///< with all scatter
};

/// A value with its standard error, above 0.
struct Measured {
  double value = 0.0;
  double standard_error = 1.0;
};

/// The mean of values weighted by their errors.
struct WeightedMean {
  double value = 0.0;
  double standard_error = 0.0;
  double chance = 1.0;  ///< that equal values scatter as much as these do by their errors
};

/// Returns the mean of at least one value.
inline WeightedMean weighted_mean(const std::vector<Measured>& all) {
  double weights = 0.0;
  double sum = 0.0;
  for (const Measured& one : all) {
    const double weight = 1.0 / (one.standard_error * one.standard_error);
    weights += weight;
    sum += weight * one.value;
  }
  WeightedMean mean{sum / weights, 1.0 / std::sqrt(weights), 1.0};
  if (all.size() < 2) return mean;
  double square = 0.0;
  for (const Measured& one : all) square += std::pow((one.value - mean.value) / one.standard_error, 2);
  mean.chance = chi_squared_above(square, static_cast<double>(all.size()) - 1.0);
  return mean;
}

}  // namespace slipfit::fit
