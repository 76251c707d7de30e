#pragma once

#include <string>
#include <vector>

#include "report/format.hpp"
#include "slipfit/compare.hpp"

namespace slipfit {

/// "A and B differ in 2 of 9 quantities: ..., ...".
std::string comparison_sentence(const Comparison& comparison);

/// "fdm_232g (3 recordings, stick-slip, 1.67 mm/s, 2.28 N)".
std::string side_text(const ComparisonSide& side);

/// A quantity that was compared, as one row of a table for people.
struct ComparisonRow {
  std::string words;  ///< with the unit
  EstimateRow a, b, difference, ratio;
  std::string p_value, p_adjusted;
  std::string note;  ///< why there is no ratio; what a status asks for
  bool differs = false;
};
std::vector<ComparisonRow> comparison_rows(const Comparison& comparison);

/// Quantities that were not, by their common reason.
struct NotCompared {
  std::string words;
  std::string reason;
};
std::vector<NotCompared> not_compared(const Comparison& comparison);

}  // namespace slipfit
