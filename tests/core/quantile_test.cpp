#include "core/statistics.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using slipfit::median;
using slipfit::nth_smallest;

namespace {

std::vector<double> some_values(std::size_t count, double step) {
  std::mt19937_64 generator(count);
  std::vector<double> values(count);
  for (double& value : values) value = step * std::floor(static_cast<double>(generator() % 1000) / step);
  return values;
}

}  // namespace

TEST_CASE("the value at any place is that of the sorted values") {
  for (const std::size_t count : {1U, 2U, 24U, 25U, 100U, 4001U}) {
    for (const double step : {1.0, 100.0, 2000.0}) {  // few of the same, many, all of them
      const std::vector<double> values = some_values(count, step);
      std::vector<double> sorted = values;
      std::sort(sorted.begin(), sorted.end());
      for (std::size_t index = 0; index < count; index += 1 + count / 7) {
        std::vector<double> changed = values;
        CHECK(nth_smallest(changed, index) == sorted[index]);
        CHECK(std::is_permutation(changed.begin(), changed.end(), values.begin()));
      }
    }
  }
}

TEST_CASE("the median of values in order, and in the opposite order, is the one in the middle") {
  std::vector<double> values(200000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  CHECK(median(values) == 100000.0);
  std::reverse(values.begin(), values.end());
  CHECK(median(values) == 100000.0);
}

TEST_CASE("values that are no numbers end the search") {
  std::vector<double> values(100, std::numeric_limits<double>::quiet_NaN());
  CHECK(std::isnan(nth_smallest(values, 50)));
}
