#include "core/clock_step.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace slipfit;

namespace {

std::vector<double> stamps(double step_s, double rounding_s) {
  std::vector<double> time_s;
  for (int i = 0; i < 5000; ++i) time_s.push_back(rounding_s * std::round(step_s * i / rounding_s));
  return time_s;
}

}  // namespace

TEST_CASE("stamps of an even clock that were rounded coarsely give the clock") {
  const double step_s = GENERATE(2e-4, 1.37e-4, 1.5e-3);
  CAPTURE(step_s);
  const auto clock = rounded_clock(stamps(step_s, 1e-3));
  REQUIRE(clock);
  CHECK(clock->step_s == Approx(step_s).epsilon(1e-5));
  CHECK(clock->rounding_s == Approx(1e-3));
  CHECK(std::abs(clock->begin_s) < 0.5e-3);  // half of what the stamps are rounded to
}

TEST_CASE("stamps of an even clock without a sample give it to half a step") {
  std::vector<double> time_s = stamps(2e-4, 1e-3);
  time_s.erase(time_s.begin() + 2345);
  const auto clock = rounded_clock(time_s);
  REQUIRE(clock);
  CHECK(std::abs(clock->begin_s + clock->step_s * 4998.0 - 4999.0 * 2e-4) < 1.1e-4);
}

TEST_CASE("other stamps are no rounded clock: even, with a gap, uneven") {
  CHECK_FALSE(rounded_clock(stamps(1e-3, 1e-6)));
  std::vector<double> time_s = stamps(1e-3, 1e-6);
  time_s.erase(time_s.begin() + 2345);
  CHECK_FALSE(rounded_clock(time_s));
  for (std::size_t i = 0; i < time_s.size(); ++i) time_s[i] += 4e-4 * std::sin(static_cast<double>(i * i));
  CHECK_FALSE(rounded_clock(time_s));
}
