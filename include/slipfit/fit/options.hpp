#pragma once

#include <optional>

#include "slipfit/fit/parameter.hpp"
#include "slipfit/fit/result.hpp"

namespace slipfit {

struct FitOptions {
  std::optional<Tier> tier{};  ///< empty: chosen by the data
  HeldParameters held{};
  bool curve = false;  ///< fill FitResult::curve (16 bytes a sample)
};

}  // namespace slipfit
