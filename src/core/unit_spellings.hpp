#pragma once

#include <array>
#include <numbers>
#include <string_view>

#include "slipfit/core/units.hpp"

namespace slipfit {

constexpr double kStandardGravity_m_per_s2 = 9.80665;  // exact by definition (CGPM 1901)
constexpr double kTurn_rad = 2.0 * std::numbers::pi;

struct Spelling {
  Dimension dimension;
  std::string_view text;
  double scale;
};

// What recordings say most often. It stands before UDUNITS-2 for two reasons: reading UDUNITS' XML takes 5 to 9 ms,
// half the time that 200 000 rows take; and UDUNITS means something else by some of it ("rpm" is rad/s there,
// "Min" a mega-inch, "S" siemens). tests/core/units_test.cpp compares the shared part with UDUNITS.
constexpr std::array kSpellings = std::to_array<Spelling>({
    {Dimension::Time, "s", 1.0},
    {Dimension::Time, "ms", 1e-3},
    {Dimension::Time, "us", 1e-6},
    {Dimension::Time, "min", 60.0},
    {Dimension::Time, "h", 3600.0},
    {Dimension::Length, "m", 1.0},
    {Dimension::Length, "cm", 1e-2},
    {Dimension::Length, "mm", 1e-3},
    {Dimension::Length, "um", 1e-6},
    {Dimension::Length, "nm", 1e-9},
    {Dimension::Speed, "m/s", 1.0},
    {Dimension::Speed, "mm/s", 1e-3},
    {Dimension::Speed, "um/s", 1e-6},
    {Dimension::Speed, "mm/min", 1e-3 / 60.0},
    {Dimension::Speed, "m/min", 1.0 / 60.0},
    {Dimension::Force, "N", 1.0},
    {Dimension::Force, "kN", 1e3},
    {Dimension::Force, "mN", 1e-3},
    {Dimension::Force, "uN", 1e-6},
    {Dimension::Force, "g", 1e-3 * kStandardGravity_m_per_s2},
    {Dimension::Force, "gf", 1e-3 * kStandardGravity_m_per_s2},
    {Dimension::Force, "kg", kStandardGravity_m_per_s2},
    {Dimension::Force, "kgf", kStandardGravity_m_per_s2},
    {Dimension::Force, "oz", 0.028349523125 * kStandardGravity_m_per_s2},  // UDUNITS: a fluid ounce
    {Dimension::Frequency, "Hz", 1.0},
    {Dimension::Frequency, "kHz", 1e3},
    {Dimension::Frequency, "1/s", 1.0},
    {Dimension::Frequency, "S/s", 1.0},
    {Dimension::Frequency, "kS/s", 1e3},
    {Dimension::AngularSpeed, "rad/s", 1.0},
    {Dimension::AngularSpeed, "1/min", kTurn_rad / 60.0},
    {Dimension::AngularSpeed, "min-1", kTurn_rad / 60.0},
    {Dimension::AngularSpeed, "Hz", kTurn_rad},
    {Dimension::Dimensionless, "1", 1.0},
    {Dimension::Dimensionless, "-", 1.0},
    {Dimension::Dimensionless, "%", 1e-2},
    {Dimension::Dimensionless, "ppm", 1e-6},
});

// Words and abbreviations that mean the same in capitals: "Sec", "MIN", "RPM", "KGF".
constexpr std::array kWords = std::to_array<Spelling>({
    {Dimension::Time, "s", 1.0},
    {Dimension::Time, "sec", 1.0},
    {Dimension::Time, "secs", 1.0},
    {Dimension::Time, "second", 1.0},
    {Dimension::Time, "seconds", 1.0},
    {Dimension::Time, "sek", 1.0},
    {Dimension::Time, "msec", 1e-3},
    {Dimension::Time, "msecs", 1e-3},
    {Dimension::Time, "millis", 1e-3},
    {Dimension::Time, "usec", 1e-6},
    {Dimension::Time, "usecs", 1e-6},
    {Dimension::Time, "micros", 1e-6},
    {Dimension::Time, "min", 60.0},
    {Dimension::Time, "mins", 60.0},
    {Dimension::Time, "hr", 3600.0},
    {Dimension::Time, "hrs", 3600.0},
    {Dimension::Length, "micron", 1e-6},
    {Dimension::Length, "microns", 1e-6},
    {Dimension::Speed, "m/sec", 1.0},
    {Dimension::Speed, "mm/sec", 1e-3},
    {Dimension::Speed, "um/sec", 1e-6},
    {Dimension::Speed, "microns/s", 1e-6},
    {Dimension::Speed, "mps", 1.0},
    {Dimension::Force, "newton", 1.0},
    {Dimension::Force, "newtons", 1.0},
    {Dimension::Force, "gf", 1e-3 * kStandardGravity_m_per_s2},
    {Dimension::Force, "p", 1e-3 * kStandardGravity_m_per_s2},
    {Dimension::Force, "kgf", kStandardGravity_m_per_s2},
    {Dimension::Force, "kp", kStandardGravity_m_per_s2},
    {Dimension::Force, "lbf", 0.45359237 * kStandardGravity_m_per_s2},
    {Dimension::Force, "lbs", 0.45359237 * kStandardGravity_m_per_s2},
    {Dimension::Force, "kn", 1e3},
    {Dimension::Frequency, "hz", 1.0},
    {Dimension::Frequency, "khz", 1e3},
    {Dimension::Frequency, "sps", 1.0},
    {Dimension::Frequency, "samples/s", 1.0},
    {Dimension::Frequency, "rpm", 1.0 / 60.0},
    {Dimension::AngularSpeed, "rpm", kTurn_rad / 60.0},
    {Dimension::AngularSpeed, "r/min", kTurn_rad / 60.0},
    {Dimension::AngularSpeed, "rev/min", kTurn_rad / 60.0},
    {Dimension::AngularSpeed, "u/min", kTurn_rad / 60.0},
    {Dimension::AngularSpeed, "rps", kTurn_rad},
    {Dimension::AngularSpeed, "rev/s", kTurn_rad},
    {Dimension::AngularSpeed, "deg/s", kTurn_rad / 360.0},
    {Dimension::AngularSpeed, "\xC2\xB0/s", kTurn_rad / 360.0},
});

}  // namespace slipfit
