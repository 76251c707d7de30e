#pragma once

#include <array>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string_view>

namespace slipfit {

constexpr double kStandardGravity_m_per_s2 = 9.80665;  // exact by definition (CGPM 1901)
constexpr double kTurn_rad = 2.0 * std::numbers::pi;

enum Base : std::size_t { kLength, kMass, kTime, kCurrent, kTemperature, kLight, kAngle, kTurns, kOther, kBases };

/// Exponents of the bases. Turns are kept apart from radians: "rpm" is a frequency too, "rad/s" is not. `kOther` is
/// for what slipfit recognises and never converts, such as counts, decibels and humidity.
using Powers = std::array<int, kBases>;

constexpr Powers kPureNumber{};
constexpr Powers kMetre{1};
constexpr Powers kKilogram{0, 1};
constexpr Powers kSecond{0, 0, 1};
constexpr Powers kPerSecond{0, 0, -1};
constexpr Powers kSpeed{1, 0, -1};
constexpr Powers kNewton{1, 1, -2};
constexpr Powers kKilogramMetre{1, 1};
constexpr Powers kNewtonPerMetre{0, 1, -2};
constexpr Powers kSecondPerMetre{-1, 0, 1};
constexpr Powers kNewtonPerSecond{1, 1, -3};
constexpr Powers kJoule{2, 1, -2};
constexpr Powers kVolt{2, 1, -3, -1};
constexpr Powers kTurnsPerSecond{0, 0, -1, 0, 0, 0, 0, 1};
constexpr Powers kRadiansPerSecond{0, 0, -1, 0, 0, 0, 1};

/// A parsed unit: a factor to SI and the powers of the bases.
struct ParsedUnit {
  double factor = 1.0;
  Powers powers{};
};

/// Units of the table with prefixes, their products ("N m", "N*m", "N.m"), quotients ("mm/min", from left to right) and
/// whole powers ("s-1", "mm^3", "m\xC2\xB2"), brackets included ("mm3/(N m)"). Capitals count where they make a unit of
/// the table, else not ("RPM", "Sec", "MM/S"). Empty where the text is no unit.
std::optional<ParsedUnit> read_unit(std::string_view text);

}  // namespace slipfit
