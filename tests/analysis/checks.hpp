#pragma once

#include <algorithm>
#include <string>

#include "slipfit/analysis.hpp"
#include "support/holds.hpp"

namespace slipfit {

using test::holds;

inline bool warns(const Analysis& analysis, const std::string& code) {
  return std::any_of(analysis.warnings.begin(), analysis.warnings.end(),
                     [&](const Warning& warning) { return warning.code == code; });
}

}  // namespace slipfit
