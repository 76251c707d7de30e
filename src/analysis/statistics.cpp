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

}  // namespace slipfit
