#include "analysis/statistics.hpp"

#include <cmath>
#include <numeric>

namespace slipfit {

MeanAndSpread describe(const std::vector<double>& values) {
  MeanAndSpread result;
  result.count = static_cast<double>(values.size());
  if (values.empty()) return result;
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / result.count;
  for (const double value : values) result.sd += (value - result.mean) * (value - result.mean);
  result.sd = values.size() > 1 ? std::sqrt(result.sd / (result.count - 1.0)) : 0.0;
  return result;
}

Slope slope_of(std::span<const double> x, std::span<const double> y) {
  const auto count = static_cast<double>(x.size());
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / count;
  const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / count;
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
