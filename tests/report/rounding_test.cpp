#include "report/format.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <string>
#include <vector>

using slipfit::rounded;

TEST_CASE("a value is rounded to two significant digits of its standard error") {
  CHECK(rounded(12.345678, 0.01234) == "12.346");
  CHECK(rounded(12.345678, 1.234) == "12.3");
  CHECK(rounded(12.345678, 12.34) == "12");
  CHECK(rounded(1234.5, 123.0) == "1230");
  CHECK(rounded(-0.051234, 0.0011) == "-0.0512");
  CHECK(rounded(0.0, 0.012) == "0.000");
  CHECK(rounded(-0.0001, 0.012) == "0.000");
  CHECK(rounded(0.001, 0.5) == "0.00");
}

TEST_CASE("without a standard error four digits are written") {
  CHECK(rounded(12.345678, std::nullopt) == "12.35");
  CHECK(rounded(0.00123456, std::nullopt) == "0.001235");
  CHECK(rounded(123456.0, std::nullopt) == "123500");
  CHECK(rounded(0.0, std::nullopt) == "0");
  CHECK(rounded(5.0, 0.0) == "5.000");
  CHECK(rounded(5.0, std::numeric_limits<double>::infinity()) == "5.000");
}

TEST_CASE("very large and very small numbers are scientific") {
  CHECK(rounded(1.23456e-6, 1.2e-9) == "1.2346e-06");
  CHECK(rounded(1.23456e9, 1.2e7) == "1.235e+09");
  CHECK(rounded(1.0, 1e-40) == "1.00000000");
}

TEST_CASE("infinite numbers and NaN are not written as numbers") {
  CHECK(rounded(std::numeric_limits<double>::quiet_NaN(), 1.0) == "-");
  CHECK(slipfit::with_error({}) == "-");
  CHECK(estimate_row(slipfit::Estimate{}, "").value == "-");
  CHECK(estimate_row(slipfit::Estimate{}, "").interval.empty());
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(estimate_row(slipfit::Estimate{1.0, 0.1, slipfit::Interval{0.0, infinity}, ""}, "").interval.empty());
}

TEST_CASE("the interval is rounded like the value") {
  const slipfit::Estimate estimate{5.43210, 0.0123, slipfit::Interval{5.40801, 5.45623}, ""};
  CHECK(estimate_row(estimate, "").value == "5.432");
  CHECK(estimate_row(estimate, "").interval == "[5.408, 5.456]");
  CHECK(slipfit::with_error(estimate) == "5.432 ± 0.012");
}

TEST_CASE("a bounded value is rounded by the width of its interval") {
  const slipfit::Estimate estimate{1.5, std::nullopt, slipfit::Interval{1.0123, 2.0123}, ""};
  CHECK(estimate_row(estimate, "").interval == "[1.01, 2.01]");
}

TEST_CASE("prefixes bring a number to between 1 and 1000") {
  CHECK(slipfit::display_unit("m", 0.00184).unit == "mm");
  CHECK(slipfit::display_unit("m", 4.2e-5).unit == "µm");
  CHECK(slipfit::display_unit("m", 4.2).unit == "m");
  CHECK(slipfit::display_unit("N", -0.012).unit == "mN");
  CHECK(slipfit::display_unit("kg", 0.0307).unit == "g");
  CHECK(slipfit::display_unit("kg", 3e-5).unit == "mg");
  CHECK(slipfit::display_unit("kg", 3e-5).per_SI == 1e6);
  CHECK(slipfit::display_unit("m/s", 0.01).unit == "mm/s");
  CHECK(slipfit::display_unit("1/m", 500.0).unit == "1/mm");
  CHECK(slipfit::display_unit("N/m", 0.01).unit == "N/m");
  CHECK(slipfit::display_unit("m", std::nullopt).unit == "m");
  CHECK(slipfit::display_unit("m", 0.0).unit == "m");
}

TEST_CASE("speeds in notes are in the unit that the user gives speeds in") {
  CHECK(slipfit::in_speed_unit("above 0.0025 m/s, the fastest run", "mm/min") == "above 150 mm/min, the fastest run");
  CHECK(slipfit::in_speed_unit("0.001 m/s to 2e-3 m/s", "mm/s") == "1 mm/s to 2 mm/s");
  CHECK(slipfit::in_speed_unit("above 0.0025 m/s", "") == "above 2.5 mm/s");
  CHECK(slipfit::in_speed_unit("an acceleration of 2 m/s2", "mm/s") == "an acceleration of 2 m/s2");
  CHECK(slipfit::in_speed_unit("in m/s", "mm/s") == "in m/s");
  CHECK(slipfit::in_speed_unit(" m/s", "mm/s") == " m/s");
}

TEST_CASE("a line does not end between a number and its unit") {
  const std::string words(slipfit::kLineWidth - 6, 'x');
  CHECK(slipfit::wrapped("", words + " by 7 % of it") == std::vector<std::string>{words + " by", "7 % of it"});
  CHECK(slipfit::wrapped("", words + " at 7.") == std::vector<std::string>{words + " at 7."});
}
