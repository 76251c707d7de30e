#include "fit/report/correlation.hpp"

#include <algorithm>
#include <cmath>

namespace slipfit::fit {

Correlation correlation_of(const ModelEstimate& estimate, const std::vector<std::size_t>& used) {
  Correlation correlation;
  for (const std::size_t i : used) {
    correlation.names.emplace_back(info(kModelParameters[i]).key);
    correlation.matrix.emplace_back();
    for (const std::size_t j : used) {
      const double scale = std::sqrt(std::max(0.0, estimate.covariance[i][i] * estimate.covariance[j][j]));
      correlation.matrix.back().push_back(i == j ? 1.0 : scale > 0.0 ? estimate.covariance[i][j] / scale : 0.0);
    }
  }
  return correlation;
}

}  // namespace slipfit::fit
