// Intervals, p values and ratios of two sides.
#include "compare/statistics.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "core/statistics.hpp"

using namespace slipfit;
using namespace slipfit::comparing;

namespace {

std::vector<Estimate> exact(const std::vector<double>& values) {
  std::vector<Estimate> estimates;
  for (const double value : values) estimates.push_back({value, {}, {}, {}});
  return estimates;
}

struct Scene {
  std::mt19937_64 dice{20251122};
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(dice); }
  double normal() { return std::normal_distribution<double>()(dice); }
  /// With an interval that may be lopsided.
  Estimate estimate() {
    const double value = uniform(1.0, 3.0);
    const double longer = uniform(0.05, 0.9);
    const double shorter = longer * uniform(0.3, 1.0);
    const bool up = uniform(0.0, 1.0) < 0.5;
    return {value,
            longer / uniform(1.96, 2.5),
            Interval{value - (up ? shorter : longer), value + (up ? longer : shorter)},
            {}};
  }
};

bool holds(const Interval& interval, double value) {
  return interval.low <= value && value <= interval.high;
}

}  // namespace

TEST_CASE("Welch's test gives the published numbers of an example") {
  // Means 20.82 and 22.98: t = -2.46, 25.0 degrees of freedom, P = 0.021 (Wikipedia, "Welch's t-test", example 1).
  const auto a = exact({27.5, 21.0, 19.0, 23.6, 17.0, 17.9, 16.9, 20.1, 21.9, 22.6, 23.1, 19.6, 19.0, 21.7, 21.4});
  const auto b = exact({27.1, 22.0, 20.8, 23.4, 23.4, 23.5, 25.8, 22.0, 24.8, 20.2, 21.9, 22.1, 22.9, 20.5, 24.4});
  const auto pair = by_scatter(a, b);
  REQUIRE(pair);
  CHECK(pair->degrees_of_freedom == Approx(25.0).margin(0.05));
  const Estimate difference = difference_of(*pair);
  CHECK(*difference.value / *difference.standard_error == Approx(2.46).margin(0.005));
  CHECK(*p_value_of(*pair) == Approx(0.021).margin(0.0005));
}

TEST_CASE("Holm's p values are those of the step-down rule") {
  const std::vector<double> adjusted = holm({0.01, 0.04, 0.03, 0.005});
  const std::vector<double> expected{0.03, 0.06, 0.06, 0.02};  // 3 * 0.01, the one before, 2 * 0.03, 4 * 0.005
  for (std::size_t i = 0; i < expected.size(); ++i) CHECK(adjusted[i] == Approx(expected[i]));
  CHECK(holm({}).empty());
  CHECK(holm({0.4, 0.5, 0.6}) == std::vector<double>{1.0, 1.0, 1.0});
}

TEST_CASE("difference, ratio and p value never disagree, and A and B may change places") {
  Scene scene;
  for (int i = 0; i < 2000; ++i) {
    CAPTURE(i);
    const Estimate first = scene.estimate();
    const Estimate second = scene.estimate();
    const auto pair = by_standard_errors(first, second);
    REQUIRE(pair);
    const Estimate difference = difference_of(*pair);
    const Estimate ratio = ratio_of(*pair);
    const bool differ = !holds(*difference.ci95, 0.0);
    CHECK((*p_value_of(*pair) < 0.05) == differ);
    if (!ratio.value) continue;
    CHECK(holds(*ratio.ci95, *ratio.value));
    CHECK(holds(*ratio.ci95, 1.0) != differ);
    const auto other = by_standard_errors(second, first);
    CHECK(difference_of(*other).ci95->low == Approx(-difference.ci95->high));
    CHECK(*p_value_of(*other) == Approx(*p_value_of(*pair)));
    const Estimate inverse = ratio_of(*other);
    if (inverse.value && ratio.ci95->low > 0.0) CHECK(inverse.ci95->high == Approx(1.0 / ratio.ci95->low));
  }
}

TEST_CASE("a ratio has no value where what it is over may be zero, and ends at zero where B may be") {
  const auto none = by_standard_errors(symmetric(1.0, 0.6, 50.0), symmetric(2.0, 0.1, 50.0));
  CHECK_FALSE(ratio_of(*none).value);
  CHECK_FALSE(ratio_of(*none).note.empty());
  const auto open = by_standard_errors(symmetric(2.0, 0.1, 50.0), Estimate{0.0, 0.2, Interval{0.0, 0.4}, {}});
  CHECK(ratio_of(*open).ci95->low == 0.0);
  CHECK(ratio_of(*open).ci95->high == Approx(0.2).epsilon(0.02));  // 0.4 / 2
}

TEST_CASE("recordings that agree by chance, or at a bound, scatter by at least their standard errors") {
  const Estimate at_bound{0.0, 0.02, Interval{0.0, 0.05}, {}};
  const std::vector<Estimate> zeros(3, at_bound);
  const std::vector<Estimate> small(3, symmetric(0.012, 0.001, 30.0));
  const auto pair = by_scatter(zeros, small);
  REQUIRE(pair);
  CHECK(*p_value_of(*pair) > 0.05);
  CHECK(mean_of(zeros).standard_error == Approx(0.02 / std::sqrt(3.0)));
  CHECK_FALSE(by_scatter(exact({1.0, 1.0}), exact({1.0, 1.0})));
}

TEST_CASE("one recording against repeats is assumed to scatter as they do") {
  const auto pair = by_scatter(exact({1.0, 2.0, 3.0}), exact({2.5}));
  REQUIRE(pair);
  CHECK(pair->degrees_of_freedom == 2.0);
  CHECK(difference_of(*pair).standard_error == Approx(std::sqrt(1.0 / 3.0 + 1.0)));
  const std::vector<Estimate> poor{symmetric(2.5, 4.0, 100.0)};
  CHECK(difference_of(*by_scatter(exact({1.0, 2.0, 3.0}), poor)).standard_error == Approx(std::sqrt(1.0 / 3.0 + 16.0)));
}

TEST_CASE("5 in 100 comparisons of equal sides give a p value below 0.05") {
  Scene scene;
  constexpr int kTrials = 4000;
  const auto measured = [&scene](double scatter) {
    const double se = scene.uniform(0.01, 0.04);
    return symmetric(1.0 + scatter * scene.normal() + se * scene.normal(), se, 200.0);
  };
  int alone = 0;
  int repeats = 0;
  for (int i = 0; i < kTrials; ++i) {
    alone += *p_value_of(*by_standard_errors(measured(0.0), measured(0.0))) < 0.05 ? 1 : 0;
    const std::vector<Estimate> a{measured(0.05), measured(0.05), measured(0.05)};
    const std::vector<Estimate> b{measured(0.05), measured(0.05), measured(0.05)};
    repeats += *p_value_of(*by_scatter(a, b)) < 0.05 ? 1 : 0;
  }
  // 5 % of 4000 within three standard deviations (14); Welch's test of three against three stays below.
  CHECK(alone == Approx(200).margin(42));
  CHECK(repeats < 242);
  CHECK(repeats > 60);
}
