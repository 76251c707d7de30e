#include "slipfit/core/range.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <variant>

#include "slipfit/core/result.hpp"

using namespace slipfit;

TEST_CASE("an interval that ends outside every quantity is not finite") {
  // Fit documents with such numbers are refused: the program must not write them either.
  const Estimate estimate = within({2.0, 1.0, Interval{1e-3, 1.2e104}, {}}, kNotNegative);
  CHECK(estimate.value == 2.0);
  CHECK_FALSE(estimate.ci95);
  CHECK(estimate.note == "the data give no finite interval");
  CHECK(within({2.0, 1.0, Interval{1e-3, 1e99}, {}}, kNotNegative).ci95);
  CHECK_FALSE(within(1e101, kAnyNumber));
  CHECK_FALSE(within(-1e101, kAnyNumber));
  CHECK_FALSE(within(std::numeric_limits<double>::quiet_NaN(), kAnyNumber));
}

TEST_CASE("the value of a failed result throws, as does the error of a good one") {
  const Result<int> failed(Error{"code", "message"});
  CHECK_THROWS_AS(failed.value(), std::bad_variant_access);
  CHECK_THROWS_AS(Result<int>(1).error(), std::bad_variant_access);
}
