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
  Torque          ///< N m ("in lb" included)
};

/// value in SI = scale * value in the unit. (No unit that slipfit accepts has an offset.)
struct UnitScale {
  double scale = 1.0;
};

/// "mm/min", "gf", "um/s", "mN", "µs", "%" ... with SI prefixes, products, quotients and powers of them.
/// Error `unknown_unit` where the text is no unit or has another dimension.
Result<UnitScale> parse_unit(std::string_view unit, Dimension dimension);

/// The unit of a number with a unit, as it was written: "mm/min" of "600 mm/min"; empty where there is none.
std::string_view unit_in(std::string_view text);

/// A number alone (already SI) or a number with a unit: "0.01", "10mm/s", "600 mm/min", "41 gf".
/// Errors `bad_number`, `unknown_unit`. Only finite numbers are accepted.
Result<double> parse_quantity(std::string_view text, Dimension dimension);

}  // namespace slipfit
