#include "signal/turning_points.hpp"

#include <Eigen/Core>
#include <algorithm>

namespace slipfit::signal {

/// Adds a block of values. If nothing can turn in a block, whatever the order of its values, only the highest or lowest
/// value so far moves. Blocks are small because a ramp rises more within a longer one.
void TurningPoints::add(std::size_t first, std::span<const double> values) {
  constexpr std::size_t kBlock = 8;
  std::size_t i = 0;
  for (; i + kBlock <= values.size(); i += kBlock) {
    const double* const block = &values[i];
    const Eigen::Map<const Eigen::Array<double, kBlock, 1>> looked_at(block);
    const double low = looked_at.minCoeff();
    const double high = looked_at.maxCoeff();
    const auto place_of = [&](double value) {
      return first + i + static_cast<std::size_t>(std::find(block, block + kBlock, value) - block);
    };
    if (falling_ && high <= std::min(lowest_, low) + hysteresis_) {
      if (low >= lowest_) continue;
      low_ = place_of(low);
      lowest_ = low;
    } else if (!falling_ && low >= std::max(highest_, high) - hysteresis_) {
      if (high <= highest_) continue;
      high_ = place_of(high);
      highest_ = high;
    } else {
      for (std::size_t k = 0; k < kBlock; ++k) add(first + i + k, block[k]);
    }
  }
  for (; i < values.size(); ++i) add(first + i, values[i]);
}

}  // namespace slipfit::signal
