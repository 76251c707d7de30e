#include "slipfit/surface/comparison.hpp"

#include <catch2/catch.hpp>

#include "surfaces.hpp"

using slipfit::compare_spacings;
using slipfit::Estimate;
using slipfit::Interval;

namespace {

Estimate known(double value, double half) {
  return {value, half / 1.96, Interval{value - half, value + half}, {}};
}

}  // namespace

TEST_CASE("E_n takes the 95 % reach of both spacings", "[surface]") {
  const auto compared = compare_spacings(known(100e-6, 3e-6), known(105e-6, 4e-6));
  CHECK(*compared.En.value == Approx(1.0));  // 5 over the root of 9 + 16
  CHECK(*compared.ratio.value == Approx(1.05));
  CHECK_THAT(compare_spacings(known(100e-6, 3e-6), known(104e-6, 4e-6)).verdict, Catch::StartsWith("agrees"));
}

TEST_CASE("a pattern of every second slip is distinguished from one without relation to the slips", "[surface]") {
  CHECK_THAT(compare_spacings(known(100e-6, 2e-6), known(201e-6, 3e-6)).verdict, Catch::Contains("2 times as coarse"));
  CHECK_THAT(compare_spacings(known(100e-6, 2e-6), known(33.5e-6, 0.5e-6)).verdict, Catch::Contains("3 times as fine"));
  CHECK_THAT(compare_spacings(known(100e-6, 2e-6), known(150e-6, 3e-6)).verdict, Catch::StartsWith("no relation"));
  CHECK_THAT(compare_spacings(known(100e-6, 1e-6), known(103e-6, 1e-6)).verdict, Catch::StartsWith("nearly the same"));
  // At a tenth of reach every ratio above two is next to some whole number.
  CHECK_THAT(compare_spacings(known(100e-6, 10e-6), known(600e-6, 60e-6)).verdict, Catch::StartsWith("no relation"));
}

TEST_CASE("without one of the spacings there is no score, but a reason", "[surface]") {
  const Estimate none{std::nullopt, std::nullopt, std::nullopt, "nothing repeats"};
  const auto compared = compare_spacings(known(1e-4, 1e-6), none);
  CHECK_FALSE(compared.En.value);
  CHECK_THAT(compared.verdict, Catch::Contains("nothing repeats"));
  CHECK_FALSE(compare_spacings(none, known(1e-4, 1e-6)).ratio.value);
}

TEST_CASE("conditions without a track stay as they are, a track that is not there is an error", "[surface]") {
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = 0.5;
  const auto same = slipfit::with_worn_track(conditions, {});
  REQUIRE(same);
  CHECK_FALSE(same.value().worn_track);
  const auto missing = slipfit::with_worn_track(conditions, "no/such/file.x3p");
  REQUIRE_FALSE(missing);
  CHECK(missing.error().code == "file_not_found");
}
