#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "io/names.hpp"

using slipfit::reading::classify_unit;
using slipfit::reading::UnitClass;

TEST_CASE("units of columns other than the force are recognised as units") {
  for (const std::string unit : {"dB",          "dB(A)",     "lux",    "mm^3", "mm\xC2\xB3",   "%RH",  "% rF",   "Ohm",
                                 "k\xCE\xA9",   "sccm",      "mm/s^2", "m/s2", "\xC2\xB0\x43", "degC", "V",      "mV/V",
                                 "Nm/s",        "mm3/(N m)", "N/mm2",  "MPa",  "mbar",         "psi",  "counts", "a.u.",
                                 "\xC2\xB5m/m", "mPa s",     "ml/min", "kA",   "\xC2\xB0",     "J",    "W/m"}) {
    CAPTURE(unit);
    CHECK(classify_unit(unit) == UnitClass::Other);
  }
}

TEST_CASE("units of time, length, force and number are distinguished, with and without capitals") {
  struct Known {
    std::string unit;
    UnitClass unit_class;
  };
  const std::vector<Known> known = {
      {"Sec", UnitClass::Time},       {"MS", UnitClass::Time},        {"\xC2\xB5s", UnitClass::Time},
      {"MM", UnitClass::Length},      {"inch", UnitClass::Length},    {"KN", UnitClass::Force},
      {"daN", UnitClass::Force},      {"ozf", UnitClass::Force},      {"oz", UnitClass::Mass},
      {"KG", UnitClass::Mass},        {"%", UnitClass::One},          {"-", UnitClass::One},
      {"mm/sec", UnitClass::Speed},   {"rpm", UnitClass::Rotation},   {"U/min", UnitClass::Rotation},
      {"1/min", UnitClass::Rotation}, {"deg/s", UnitClass::Rotation}, {"NM", UnitClass::Torque},
      {"Nmm", UnitClass::Torque},     {"N mm", UnitClass::Torque},    {"in-lbf", UnitClass::Torque},
      {"", UnitClass::None},          {"time", UnitClass::NotAUnit},  {"F", UnitClass::NotAUnit},
      {"left", UnitClass::NotAUnit},  {"u", UnitClass::NotAUnit},     {"Force", UnitClass::NotAUnit}};
  for (const Known& expected : known) {
    CAPTURE(expected.unit);
    CHECK(classify_unit(expected.unit) == expected.unit_class);
  }
}
