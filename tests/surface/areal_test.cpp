#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "surface/areal.hpp"

using slipfit::surface::HeightMap;

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

HeightMap tilted(double degrees) {
  std::mt19937 generator(11);
  std::normal_distribution<double> normal;
  HeightMap map{300, 200, 1e-6, 2e-6, {}, true};
  for (std::size_t row = 0; row < map.rows; ++row) {
    for (std::size_t column = 0; column < map.columns; ++column) {
      const double x = 1e-6 * static_cast<double>(column);
      const double y = 2e-6 * static_cast<double>(row);
      const double along = x * std::cos(degrees * kDegree) + y * std::sin(degrees * kDegree);
      // Curved across, and rough: neither is the pattern.
      map.values.push_back(1e-6 * (std::sin(2.0 * std::numbers::pi * along / 23e-6) + normal(generator)) + 0.2 * x * y);
    }
  }
  return map;
}

}  // namespace

TEST_CASE("the direction of sliding on an area is found, and all rows count", "[surface]") {
  for (const double degrees : {0.0, 20.0, -35.0, 90.0}) {
    const slipfit::Profile profile = slipfit::surface::profile_of(tilted(degrees), std::nullopt);
    REQUIRE(profile.along_rad);
    CAPTURE(degrees, *profile.along_rad / kDegree);
    // Half a turn is the same direction.
    const double off = std::remainder(*profile.along_rad / kDegree - degrees, 180.0);
    CHECK(std::abs(off) < 0.5);
    CHECK(profile.assumed.size() == 2);
    const auto surface = slipfit::measure_surface(profile);
    REQUIRE(surface);
    REQUIRE(surface.value().spacing_m.ci95);
    CHECK(surface.value().spacing_m.ci95->low <= 23.1e-6);
    CHECK(surface.value().spacing_m.ci95->high >= 22.9e-6);
  }
}

TEST_CASE("places that are uneven are brought onto even steps, with holes where none are", "[surface]") {
  const auto even = slipfit::surface::profile_of({0.0, 1.0, 2.0, 3.0}, {5.0, 6.0, 7.0, 8.0}, "file");
  REQUIRE(even);
  CHECK(even.value().height == std::vector<double>{5.0, 6.0, 7.0, 8.0});
  CHECK(even.value().pitch_m == 1.0);
  const auto uneven =
      slipfit::surface::profile_of({0.0, 1.0, 2.0, 10.0, 11.0, 12.0}, {0.0, 1.0, 2.0, 10.0, 11.0, 12.0}, "file");
  REQUIRE(uneven);
  CHECK(uneven.value().height.front() == 0.0);
  CHECK(std::isnan(uneven.value().height[3]));
  const auto falling = slipfit::surface::profile_of({2.0, 1.0, 0.0}, {7.0, 6.0, 5.0}, "file");
  REQUIRE(falling);
  CHECK(falling.value().height == std::vector<double>{5.0, 6.0, 7.0});
  const auto back_and_forth = slipfit::surface::profile_of({0.0, 1.0, 0.5}, {1.0, 2.0, 3.0}, "file");
  REQUIRE_FALSE(back_and_forth);
  CHECK(back_and_forth.error().code == "places_not_rising");
}
