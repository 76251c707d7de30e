#pragma once

#include <optional>

#include "analysis/detect.hpp"
#include "slipfit/analysis.hpp"

namespace slipfit {

/// Empty without a normal force (for a force column). `analysis`: with its cycles, transients and kind of motion.
std::optional<Coefficients> find_coefficients(const Detected& detected, const Analysis& analysis);

}  // namespace slipfit
