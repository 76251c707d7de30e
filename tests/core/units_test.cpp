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

struct Spelled {
  std::string text;
  Dimension dimension;
  double scale;
};

const double kGramForce_N = 9.80665e-3;
const double kRpm_rad_per_s = 2.0 * std::numbers::pi / 60.0;

const std::vector<Spelled> kUnits = {
    {"s", Dimension::Time, 1.0},
    {"sec", Dimension::Time, 1.0},
    {"secs", Dimension::Time, 1.0},
    {"SEC", Dimension::Time, 1.0},
    {"S", Dimension::Time, 1.0},
    {"msec", Dimension::Time, 1e-3},
    {"ms", Dimension::Time, 1e-3},
    {"\xC2\xB5s", Dimension::Time, 1e-6},
    {"\xCE\xBCs", Dimension::Time, 1e-6},
    {"\xB5s", Dimension::Time, 1e-6},
    {"min", Dimension::Time, 60.0},
    {"Min", Dimension::Time, 60.0},
    {"MIN.", Dimension::Time, 60.0},
    {"h", Dimension::Time, 3600.0},
    {"day", Dimension::Time, 86400.0},
    {"microns", Dimension::Length, 1e-6},
    {"\xC2\xB5m", Dimension::Length, 1e-6},
    {"inch", Dimension::Length, 0.0254},
    {"mm/min", Dimension::Speed, 1e-3 / 60.0},
    {"mm/sec", Dimension::Speed, 1e-3},
    {"um/s", Dimension::Speed, 1e-6},
    {"\xC2\xB5m/s", Dimension::Speed, 1e-6},
    {"\xCE\xBCm/s", Dimension::Speed, 1e-6},
    {"\xB5m/s", Dimension::Speed, 1e-6},
    {"m s-1", Dimension::Speed, 1.0},
    {"mm\xC2\xB7s\xE2\x81\xBB\xC2\xB9", Dimension::Speed, 1e-3},
    {" mm/s ", Dimension::Speed, 1e-3},
    {"MM/S", Dimension::Speed, 1e-3},
    {"nm/s", Dimension::Speed, 1e-9},
    {"in/s", Dimension::Speed, 0.0254},
    {"N", Dimension::Force, 1.0},
    {"mN", Dimension::Force, 1e-3},
    {"MN", Dimension::Force, 1e6},
    {"\xC2\xB5N", Dimension::Force, 1e-6},
    {"gf", Dimension::Force, kGramForce_N},
    {"g", Dimension::Force, kGramForce_N},
    {"grams", Dimension::Force, kGramForce_N},
    {"mg", Dimension::Force, 1e-3 * kGramForce_N},
    {"kgf", Dimension::Force, 1e3 * kGramForce_N},
    {"kg", Dimension::Force, 1e3 * kGramForce_N},
    {"kp", Dimension::Force, 1e3 * kGramForce_N},
    {"lbf", Dimension::Force, 4.4482216152605},
    {"lb", Dimension::Force, 4.4482216152605},
    {"oz", Dimension::Force, 0.27801385095378125},
    {"dyne", Dimension::Force, 1e-5},
    {"Newtons", Dimension::Force, 1.0},
    {"kHz", Dimension::Frequency, 1e3},
    {"1/s", Dimension::Frequency, 1.0},
    {"1/min", Dimension::Frequency, 1.0 / 60.0},
    {"rpm", Dimension::Frequency, 1.0 / 60.0},
    {"S/s", Dimension::Frequency, 1.0},
    {"rpm", Dimension::AngularSpeed, kRpm_rad_per_s},
    {"RPM", Dimension::AngularSpeed, kRpm_rad_per_s},
    {"1/min", Dimension::AngularSpeed, kRpm_rad_per_s},
    {"rad/s", Dimension::AngularSpeed, 1.0},
    {"mrad/s", Dimension::AngularSpeed, 1e-3},
    {"deg/s", Dimension::AngularSpeed, std::numbers::pi / 180.0},
    {"%", Dimension::Dimensionless, 0.01},
    {"1", Dimension::Dimensionless, 1.0},
    {"-", Dimension::Dimensionless, 1.0},
};

void check_scale(const Spelled& unit) {
  CAPTURE(unit.text);
  const auto parsed = parse_unit(unit.text, unit.dimension);
  REQUIRE(parsed.ok());
  CHECK(parsed.value().scale == Approx(unit.scale).epsilon(1e-14));
}

}  // namespace

TEST_CASE("a unit is what a tribologist means by it") {
  for (const Spelled& unit : kUnits) check_scale(unit);
}

TEST_CASE("prefixes, words, products, quotients and powers agree with the short spellings") {
  struct Pair {
    std::string usual;
    std::string other;
    Dimension dimension;
  };
  const std::vector<Pair> pairs = {
      {"s", "kg s kg-1", Dimension::Time},
      {"ms", "millisecond", Dimension::Time},
      {"us", "microseconds", Dimension::Time},
      {"min", "minute", Dimension::Time},
      {"h", "hour", Dimension::Time},
      {"cm", "centimeter", Dimension::Length},
      {"mm", "millimetres", Dimension::Length},
      {"um", "micrometer", Dimension::Length},
      {"nm", "nanometer", Dimension::Length},
      {"mm/s", "mm s-1", Dimension::Speed},
      {"um/s", "um*s^-1", Dimension::Speed},
      {"mm/min", "mm min-1", Dimension::Speed},
      {"mm/min", "millimeters per minute", Dimension::Speed},
      {"mm/min", "mm_per_min", Dimension::Speed},
      {"N m", "N_m", Dimension::Torque},
      {"m/min", "m.min-1", Dimension::Speed},
      {"m/s", "m2/(m s)", Dimension::Speed},
      {"m/s", "m\xC2\xB2/m/s", Dimension::Speed},
      {"kN", "kilonewton", Dimension::Force},
      {"kN", "KN", Dimension::Force},
      {"mN", "millinewton", Dimension::Force},
      {"N", "kg m/s^2", Dimension::Force},
      {"N", "J/m", Dimension::Force},
      {"gf", "gram_force", Dimension::Force},
      {"kgf", "kilogram_force", Dimension::Force},
      {"lbf", "pound_force", Dimension::Force},
      {"oz", "ounce_force", Dimension::Force},
      {"kHz", "kilohertz", Dimension::Frequency},
      {"rpm", "turn/min", Dimension::AngularSpeed},
      {"rpm", "U/min", Dimension::AngularSpeed},
      {"deg/s", "degree/s", Dimension::AngularSpeed},
  };
  for (const Pair& pair : pairs) {
    CAPTURE(pair.usual, pair.other);
    const auto usual = parse_unit(pair.usual, pair.dimension);
    const auto other = parse_unit(pair.other, pair.dimension);
    REQUIRE(usual.ok());
    REQUIRE(other.ok());
    CHECK(other.value().scale == Approx(usual.value().scale).epsilon(1e-14));
  }
}

TEST_CASE("capitals never make a thousand millions of a unit") {
  for (const Spelled& unit : std::vector<Spelled>{{"Mm", Dimension::Length, 1e-3},
                                                  {"Ms", Dimension::Time, 1e-3},
                                                  {"Mg", Dimension::Force, 1e-3 * kGramForce_N},
                                                  {"Min", Dimension::Time, 60.0},
                                                  {"S", Dimension::Time, 1.0}}) {
    check_scale(unit);
  }
  CHECK_FALSE(parse_unit("NM", Dimension::Length).ok());  // newton metres
  CHECK_FALSE(parse_unit("MHZ", Dimension::Frequency).ok());
  CHECK_FALSE(parse_unit("Min", Dimension::Length).ok());  // mega-inches
  CHECK_FALSE(parse_unit("S", Dimension::Frequency).ok());
  CHECK_FALSE(parse_unit("rpm", Dimension::Speed).ok());
  CHECK_FALSE(parse_unit("mV/V", Dimension::Dimensionless).ok());  // of a bridge, no friction coefficient
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
      for (int i = 0; i < 200; ++i) sum += parse_unit("inch/minute", Dimension::Speed).value().scale;
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
