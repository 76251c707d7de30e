#pragma once

#include <string>
#include <vector>

#include "slipfit/core/result.hpp"

namespace slipfit {

/// The speeds of a prediction.
struct Speeds {
  std::vector<double> speeds_m_per_s;  ///< each > 0
  std::string unit;                    ///< that the first was given in; empty: m/s
};

/// Parses "A:B:N", N logarithmically spaced speeds from A to B with exact ends, or "V1,V2,...". A unit that only the
/// last one has is that of all: "1,2,5 mm/s"; otherwise numbers without one are in m/s. Errors: bad_number,
/// unknown_unit, out_of_range, bad_speeds.
Result<Speeds> parse_speeds(const std::string& text);

}  // namespace slipfit
