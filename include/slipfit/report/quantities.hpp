#pragma once

#include <span>
#include <string>
#include <string_view>

namespace slipfit {

/// A quantity as every view shows it: text, page, CSV, comparison and Python take its words and its unit from here.
struct Quantity {
  std::string_view section;  ///< of the document
  std::string_view key;      ///< there, unit included
  std::string_view words;    ///< for people, under the heading of its section
  std::string_view unit;     ///< SI; empty for a pure number. "N" is the unit of the force column
};

/// Returns every quantity that the document of a recording or of a worn surface contains: parameters first.
std::span<const Quantity> recording_quantities();
/// Returns the quantity with this key, which must be one of `recording_quantities`.
const Quantity& quantity_with_key(std::string_view key);
/// Returns the words of a quantity where no heading says what it is of.
std::string full_words(const Quantity& quantity);

}  // namespace slipfit
