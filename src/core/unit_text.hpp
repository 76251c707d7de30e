#pragma once

#include <optional>
#include <string_view>

#include "core/unit_table.hpp"

namespace slipfit {

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
