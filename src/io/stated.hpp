#pragma once

#include <string>
#include <vector>

#include "io/layout.hpp"
#include "io/part.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit::reading {

/// Speed and load: what the user states, what the file's columns say, and whether they agree.
struct StatedConditions {
  Conditions conditions;
  std::vector<std::string> assumed;
  Warnings warnings;
};

/// What the user states counts; a column fills in what is not stated. Errors: no_speed, speed_varies.
Result<StatedConditions> state_conditions(const Rows& rows, const Choice& choice, const Layout& layout,
                                          const Conditions& conditions, const std::string& file);

}  // namespace slipfit::reading
