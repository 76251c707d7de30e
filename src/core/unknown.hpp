#pragma once

#include <optional>
#include <string>
#include <utility>

#include "slipfit/core/estimate.hpp"

namespace slipfit {

/// A number that is not known, and why.
inline Estimate unknown(std::string why) {
  return {std::nullopt, std::nullopt, std::nullopt, std::move(why)};
}

}  // namespace slipfit
