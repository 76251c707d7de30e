#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace slipfit {

/// Sums of points about their own means, of which a line of least squares is made.
struct LineSums {
  double count = 0.0, mean_x = 0.0, mean_y = 0.0;
  double square = 0.0, cross = 0.0;  ///< of x, of x and y
  double scatter = 0.0;              ///< of y

  [[nodiscard]] double slope() const { return cross / square; }
  [[nodiscard]] double at(double x) const { return mean_y + slope() * (x - mean_x); }
  /// Variance of a point about the line, for errors of their own each; 0 for two points.
  [[nodiscard]] double variance() const {
    return count > 2.0 ? std::max(0.0, scatter - slope() * cross) / (count - 2.0) : 0.0;
  }
  [[nodiscard]] double slope_error() const { return std::sqrt(variance() / square); }
};

/// Sums of the points x(0), y(0) to x(count - 1), y(count - 1).
template <class X, class Y>
LineSums line_sums(std::size_t count, const X& x, const Y& y) {
  LineSums sums;
  sums.count = static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    sums.mean_x += x(i) / sums.count;
    sums.mean_y += y(i) / sums.count;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double dx = x(i) - sums.mean_x;
    const double dy = y(i) - sums.mean_y;
    sums.square += dx * dx;
    sums.cross += dx * dy;
    sums.scatter += dy * dy;
  }
  return sums;
}

/// Returns the sums with a weight of each point, inversely proportional to the variance of y; the weights of all points
/// sum to their number.
inline LineSums weighted_line_sums(std::span<const double> x, std::span<const double> y,
                                   std::span<const double> weight) {
  LineSums sums;
  sums.count = static_cast<double>(x.size());
  double all = 0.0;
  for (const double w : weight) all += w;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sums.mean_x += weight[i] / all * x[i];
    sums.mean_y += weight[i] / all * y[i];
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double w = weight[i] / all * sums.count;
    sums.square += w * (x[i] - sums.mean_x) * (x[i] - sums.mean_x);
    sums.cross += w * (x[i] - sums.mean_x) * (y[i] - sums.mean_y);
    sums.scatter += w * (y[i] - sums.mean_y) * (y[i] - sums.mean_y);
  }
  return sums;
}

/// Returns the sums of at least two points that do not all have the same x.
inline LineSums line_sums(std::span<const double> x, std::span<const double> y) {
  return line_sums(
      x.size(), [&](std::size_t i) { return x[i]; }, [&](std::size_t i) { return y[i]; });
}

}  // namespace slipfit
