#pragma once

#include <algorithm>
#include <string>

#include "slipfit/analysis.hpp"
#include "support/holds.hpp"
#include "support/recordings.hpp"

namespace slipfit {

using test::holds;

inline bool warns(const Analysis& analysis, const std::string& code) {
  return test::warns(analysis.warnings, code);
}

}  // namespace slipfit
