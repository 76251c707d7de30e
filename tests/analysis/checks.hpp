#pragma once

#include <algorithm>
#include <string>

#include "slipfit/analysis.hpp"

namespace slipfit {

inline bool holds(const Estimate& estimate, double truth) {
  return estimate.ci95 && estimate.ci95->low <= truth && truth <= estimate.ci95->high;
}

inline bool warns(const Analysis& analysis, const std::string& code) {
  return std::any_of(analysis.warnings.begin(), analysis.warnings.end(),
                     [&](const Warning& warning) { return warning.code == code; });
}

}  // namespace slipfit
