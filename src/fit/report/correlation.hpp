#pragma once

#include <cstddef>
#include <vector>

#include "slipfit/fit/result.hpp"

namespace slipfit::fit {

/// Of the covariance of a model, rows and columns `used` (places in kModelParameters).
Correlation correlation_of(const ModelEstimate& estimate, const std::vector<std::size_t>& used);

}  // namespace slipfit::fit
