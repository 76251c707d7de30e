#pragma once

#include <functional>
#include <optional>
#include <string>

#include "slipfit/fit/parameter.hpp"
#include "slipfit/fit/result.hpp"

namespace slipfit {

struct FitOptions {
  std::optional<Tier> tier{};  ///< empty: chosen by the data
  HeldParameters held{};
  bool curve = false;  ///< fill FitResult::curve (16 bytes a sample)
  /// Told of each step of a fit of several recordings ("fitting without recording 3 of 13"); may be empty.
  std::function<void(const std::string&)> tell_step{};
};

}  // namespace slipfit
