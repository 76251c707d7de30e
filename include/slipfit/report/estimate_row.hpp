#pragma once

#include <string>

#include "slipfit/core/estimate.hpp"

namespace slipfit {

/// An estimate as people write it: rounded to two significant digits of its standard error, the interval alike.
struct EstimateRow {
  std::string value;     ///< "-" where it is not known
  std::string interval;  ///< "[low, high]"; empty where it is not known
  std::string unit;
};

/// Returns the row of an estimate in a suitable unit.
EstimateRow estimate_row(const Estimate& estimate, const std::string& SI_unit);

}  // namespace slipfit
