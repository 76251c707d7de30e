#pragma once

#include <string_view>

#include "slipfit/core/result.hpp"

namespace slipfit {

/// The dimensions that slipfit reads; each is converted to the SI unit named here.
enum class Dimension {
  Time,           ///< s
  Length,         ///< m
  Speed,          ///< m/s
  Force,          ///< N
  Frequency,      ///< Hz
  Mass,           ///< kg
  AngularSpeed,   ///< rad/s ("rpm" included)
  Dimensionless,  ///< 1 ("%" included)
  Torque,         ///< N m ("in lb" included)
  Stiffness,      ///< N/m
  Slowness,       ///< s/m, the rate of change of a logarithm with speed
  ForceRate       ///< N/s
};

/// Parses a unit such as "mm/min", "gf", "um/s", "mN", "µs", "%", with SI prefixes, products, quotients and powers, and
/// returns its factor: value in SI = factor * value in the unit. (No unit that slipfit accepts has an offset.) The
/// error is `unknown_unit` if the text is not a unit or has another dimension.
Result<double> parse_unit(std::string_view unit, Dimension dimension);

/// Returns the unit of a number as it was written: "mm/min" of "600 mm/min"; empty without a unit.
std::string_view unit_in(std::string_view text);

/// Parses a number (in SI) or a number with a unit: "0.01", "10mm/s", "600 mm/min", "41 gf". Only finite numbers are
/// accepted. Errors: `bad_number`, `unknown_unit`.
Result<double> parse_quantity(std::string_view text, Dimension dimension);

}  // namespace slipfit
