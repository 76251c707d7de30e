#pragma once

#include <string>
#include <vector>

#include "slipfit/core/result.hpp"

namespace slipfit {

/// Speeds to predict at.
struct Speeds {
  std::vector<double> speeds_m_per_s;  ///< each > 0
  std::string unit;                    ///< that the first was given in; empty: m/s
};

/// "A:B:N", N speeds from A to B in equal ratios with both ends exact, or "V1,V2,...". Errors: bad_number,
/// unknown_unit, out_of_range, bad_speeds.
Result<Speeds> parse_speeds(const std::string& text);

}  // namespace slipfit
