#include "slipfit/core/units.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

using slipfit::Dimension;
using slipfit::parse_quantity;
using slipfit::parse_unit;

namespace {

/// Spellings of one unit.
struct Spelled {
  Dimension dimension;
  double scale;
  std::vector<std::string> texts;
};

const double kGramForce_N = 9.80665e-3;
const double kRpm_rad_per_s = 2.0 * std::numbers::pi / 60.0;

const std::vector<Spelled> kUnits = {
    {Dimension::Time, 1.0, {"s", "sec", "secs", "SEC", "S"}},
    {Dimension::Time, 1e-3, {"ms", "msec", "Ms"}},
    {Dimension::Time, 1e-6, {"\xC2\xB5s", "\xCE\xBCs", "\xB5s"}},
    {Dimension::Time, 60.0, {"min", "Min", "MIN."}},
    {Dimension::Time, 3600.0, {"h"}},
    {Dimension::Time, 86400.0, {"day"}},
    {Dimension::Length, 1e-6, {"microns", "\xC2\xB5m"}},
    {Dimension::Length, 1e-3, {"Mm"}},
    {Dimension::Length, 0.0254, {"inch"}},
    {Dimension::Speed, 1.0, {"m s-1"}},
    {Dimension::Speed, 1e-3 / 60.0, {"mm/min"}},
    {Dimension::Speed, 1e-3, {"mm/sec", "mm\xC2\xB7s\xE2\x81\xBB\xC2\xB9", " mm/s ", "MM/S"}},
    {Dimension::Speed, 1e-6, {"um/s", "\xC2\xB5m/s", "\xCE\xBCm/s", "\xB5m/s"}},
    {Dimension::Speed, 1e-9, {"nm/s"}},
    {Dimension::Speed, 0.0254, {"in/s"}},
    {Dimension::Force, 1.0, {"N", "Newtons"}},
    {Dimension::Force, 1e-3, {"mN"}},
    {Dimension::Force, 1e6, {"MN"}},
    {Dimension::Force, 1e-6, {"\xC2\xB5N"}},
    {Dimension::Force, kGramForce_N, {"gf", "g", "grams"}},
    {Dimension::Force, 1e-3 * kGramForce_N, {"mg", "Mg"}},
    {Dimension::Force, 1e3 * kGramForce_N, {"kgf", "kg", "kp"}},
    {Dimension::Force, 4.4482216152605, {"lbf", "lb"}},
    {Dimension::Force, 0.27801385095378125, {"oz"}},
    {Dimension::Force, 1e-5, {"dyne"}},
    {Dimension::Frequency, 1e3, {"kHz"}},
    {Dimension::Frequency, 1.0, {"1/s", "S/s"}},
    {Dimension::Frequency, 1.0 / 60.0, {"1/min", "rpm"}},
    {Dimension::AngularSpeed, kRpm_rad_per_s, {"rpm", "RPM", "1/min"}},
    {Dimension::AngularSpeed, 1.0, {"rad/s"}},
    {Dimension::AngularSpeed, 1e-3, {"mrad/s"}},
    {Dimension::AngularSpeed, std::numbers::pi / 180.0, {"deg/s"}},
    {Dimension::Dimensionless, 0.01, {"%"}},
    {Dimension::Dimensionless, 1.0, {"1", "-"}},
};

}  // namespace

TEST_CASE("a unit is what a tribologist means by it, and capitals never make a thousand millions of it") {
  for (const Spelled& unit : kUnits) {
    for (const std::string& text : unit.texts) {
      CAPTURE(text);
      const auto parsed = parse_unit(text, unit.dimension);
      REQUIRE(parsed.ok());
      CHECK(parsed.value() == Approx(unit.scale).epsilon(1e-14));
    }
  }
  CHECK_FALSE(parse_unit("NM", Dimension::Length).ok());  // newton metres
  CHECK_FALSE(parse_unit("MHZ", Dimension::Frequency).ok());
  CHECK_FALSE(parse_unit("Min", Dimension::Length).ok());  // mega-inches
  CHECK_FALSE(parse_unit("S", Dimension::Frequency).ok());
  CHECK_FALSE(parse_unit("rpm", Dimension::Speed).ok());
  CHECK_FALSE(parse_unit("mV/V", Dimension::Dimensionless).ok());  // of a bridge, no friction coefficient
}

TEST_CASE("prefixes, words, products, quotients and powers agree with the short spellings") {
  struct Others {
    Dimension dimension;
    std::string usual;
    std::vector<std::string> others;
  };
  const std::vector<Others> spellings = {
      {Dimension::Time, "s", {"kg s kg-1"}},
      {Dimension::Time, "ms", {"millisecond"}},
      {Dimension::Time, "us", {"microseconds"}},
      {Dimension::Time, "min", {"minute"}},
      {Dimension::Time, "h", {"hour"}},
      {Dimension::Length, "cm", {"centimeter"}},
      {Dimension::Length, "mm", {"millimetres"}},
      {Dimension::Length, "um", {"micrometer"}},
      {Dimension::Length, "nm", {"nanometer"}},
      {Dimension::Speed, "mm/s", {"mm s-1"}},
      {Dimension::Speed, "um/s", {"um*s^-1"}},
      {Dimension::Speed, "mm/min", {"mm min-1", "millimeters per minute", "mm_per_min"}},
      {Dimension::Speed, "m/min", {"m.min-1"}},
      {Dimension::Speed, "m/s", {"m2/(m s)", "m\xC2\xB2/m/s"}},
      {Dimension::Torque, "N m", {"N_m"}},
      {Dimension::Force, "kN", {"kilonewton", "KN"}},
      {Dimension::Force, "mN", {"millinewton"}},
      {Dimension::Force, "N", {"kg m/s^2", "J/m"}},
      {Dimension::Force, "gf", {"gram_force"}},
      {Dimension::Force, "kgf", {"kilogram_force"}},
      {Dimension::Force, "lbf", {"pound_force"}},
      {Dimension::Force, "oz", {"ounce_force"}},
      {Dimension::Frequency, "kHz", {"kilohertz"}},
      {Dimension::AngularSpeed, "rpm", {"turn/min", "U/min"}},
      {Dimension::AngularSpeed, "deg/s", {"degree/s"}},
  };
  for (const Others& unit : spellings) {
    for (const std::string& other : unit.others) {
      CAPTURE(unit.usual, other);
      const auto usual = parse_unit(unit.usual, unit.dimension);
      const auto parsed = parse_unit(other, unit.dimension);
      REQUIRE(usual.ok());
      REQUIRE(parsed.ok());
      CHECK(parsed.value() == Approx(usual.value()).epsilon(1e-14));
    }
  }
}

TEST_CASE("a text that is no unit, or a unit of something else, is refused and named") {
  struct Wrong {
    std::string text;
    Dimension dimension;
  };
  const std::vector<Wrong> wrong = {
      {"", Dimension::Time},
      {"furlongs", Dimension::Force},
      {"mm", Dimension::Force},
      {"N", Dimension::Speed},
      {"s", Dimension::Frequency},  // no reciprocals
      {"Hz", Dimension::Time},
      {"1/s", Dimension::AngularSpeed},  // radians or turns?
      {"rad/s", Dimension::Frequency},
      {"g", Dimension::Length},
      {"N @ 5", Dimension::Force},  // an offset
      {"seconds since 1970-01-01", Dimension::Time},
      {"N m", Dimension::Force},
      {"V", Dimension::Force},
      {"rad", Dimension::Dimensionless},
      {"gram-furlong", Dimension::Force},
      {"((((N", Dimension::Force},
      {"N^", Dimension::Force},
      {"m^99 m-98", Dimension::Time},
      {"kg m/s", Dimension::Speed},
  };
  for (const Wrong& unit : wrong) {
    CAPTURE(unit.text);
    const auto parsed = parse_unit(unit.text, unit.dimension);
    REQUIRE_FALSE(parsed.ok());
    CHECK(parsed.error().code == "unknown_unit");
    CHECK(parsed.error().message.find("'" + unit.text + "'") != std::string::npos);
  }
}

TEST_CASE("a quantity is a number in SI or a number with a unit") {
  CHECK(parse_quantity("0.01", Dimension::Speed).value() == 0.01);
  CHECK(parse_quantity("10mm/s", Dimension::Speed).value() == Approx(0.01).epsilon(1e-15));
  CHECK(parse_quantity("600 mm/min", Dimension::Speed).value() == Approx(0.01).epsilon(1e-15));
  CHECK(parse_quantity("41 gf", Dimension::Force).value() == Approx(0.40207265).epsilon(1e-15));
  CHECK(parse_quantity("+5 mm", Dimension::Length).value() == Approx(5e-3).epsilon(1e-15));
  CHECK(parse_quantity("1e3um/s", Dimension::Speed).value() == Approx(1e-3).epsilon(1e-15));
  CHECK(parse_quantity("-2.5 mN", Dimension::Force).value() == Approx(-2.5e-3).epsilon(1e-15));
  CHECK(parse_quantity("3/min", Dimension::Frequency).value() == Approx(0.05).epsilon(1e-15));
  CHECK(parse_quantity("30 rpm", Dimension::AngularSpeed).value() == Approx(std::numbers::pi).epsilon(1e-15));
  CHECK(parse_quantity("5 kN/m", Dimension::Stiffness).value() == Approx(5000.0).epsilon(1e-15));
  CHECK(parse_quantity("5N/mm", Dimension::Stiffness).value() == Approx(5000.0).epsilon(1e-15));
  CHECK(parse_quantity("-2 s/mm", Dimension::Slowness).value() == Approx(-2000.0).epsilon(1e-15));
  CHECK(parse_quantity("60 mN/min", Dimension::ForceRate).value() == Approx(1e-3).epsilon(1e-15));
  CHECK(parse_quantity("12 %", Dimension::Dimensionless).value() == Approx(0.12).epsilon(1e-15));
}

TEST_CASE("a text that is not a finite number is refused as bad_number, a wrong unit after it as unknown_unit") {
  for (const std::string text :
       {"", "fast", "mm/s", "nan", "inf mm/s", "1e999", "0,5 mm/s", "--5", "+-5", "1e308 km/s"}) {
    CAPTURE(text);
    const auto parsed = parse_quantity(text, Dimension::Speed);
    REQUIRE_FALSE(parsed.ok());
    CHECK(parsed.error().code == "bad_number");
  }
  CHECK(parse_quantity("0,5 mm/s", Dimension::Speed).error().message ==
        "'0,5 mm/s' has a comma: write the decimal sign as a point");
  for (const std::string text : {"10 N", "10 furlongs/fortnight/s", "3 mm/s extra", "1.2.3"}) {
    CAPTURE(text);
    const auto parsed = parse_quantity(text, Dimension::Speed);
    REQUIRE_FALSE(parsed.ok());
    CHECK(parsed.error().code == "unknown_unit");
  }
}

TEST_CASE("units are read by several threads at once") {
  std::vector<std::thread> threads;
  std::vector<double> sums(4, 0.0);
  for (double& sum : sums) {
    threads.emplace_back([&sum] {
      for (int i = 0; i < 200; ++i) sum += parse_unit("inch/minute", Dimension::Speed).value();
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const double sum : sums) CHECK(sum == Approx(200.0 * 0.0254 / 60.0).epsilon(1e-12));
}

TEST_CASE("every unit that docs/recordings.md lists is read") {
  const std::map<std::string, Dimension> rows = {{"time", Dimension::Time},
                                                 {"length", Dimension::Length},
                                                 {"speed", Dimension::Speed},
                                                 {"force", Dimension::Force},
                                                 {"mass", Dimension::Mass},
                                                 {"frequency", Dimension::Frequency},
                                                 {"angular speed", Dimension::AngularSpeed},
                                                 {"pure number", Dimension::Dimensionless}};
  std::ifstream file(std::filesystem::path(SLIPFIT_TESTDATA_DIR).parent_path() / "docs/recordings.md");
  std::size_t found = 0;
  for (std::string line; std::getline(file, line);) {
    const auto bar = line.find(" |", 2);
    const auto row = bar == std::string::npos ? rows.end() : rows.find(line.substr(2, bar - 2));
    if (row == rows.end()) continue;
    ++found;
    for (auto open = line.find('`'); open != std::string::npos; open = line.find('`', open)) {
      const auto close = line.find('`', open + 1);
      const std::string unit = line.substr(open + 1, close - open - 1);
      CAPTURE(row->first, unit);
      CHECK(parse_unit(unit, row->second).ok());
      open = close + 1;
    }
  }
  CHECK(found == rows.size());
}
