#include "analysis/statistics.hpp"

#include <cmath>

#include "core/quantile.hpp"

namespace slipfit {

MeanAndSpread describe(const std::vector<double>& values) {
  MeanAndSpread result;
  result.count = static_cast<double>(values.size());
  if (values.empty()) return result;
  result.mean = mean_of(values);
  for (const double value : values) result.sd += (value - result.mean) * (value - result.mean);
  result.sd = values.size() > 1 ? std::sqrt(result.sd / (result.count - 1.0)) : 0.0;
  return result;
}

Slope slope_of(std::span<const double> x, std::span<const double> y) {
  const auto count = static_cast<double>(x.size());
  const double mean_x = mean_of(x);
  const double mean_y = mean_of(y);
  double cross = 0.0, square = 0.0, rest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    cross += (x[i] - mean_x) * (y[i] - mean_y);
    square += (x[i] - mean_x) * (x[i] - mean_x);
  }
  const double slope = cross / square;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double off = y[i] - mean_y - slope * (x[i] - mean_x);
    rest += off * off;
  }
  return {slope, x.size() > 2 ? std::sqrt(rest / (count - 2.0) / square) : 0.0};
}

}  // namespace slipfit
