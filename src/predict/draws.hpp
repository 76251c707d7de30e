#pragma once

#include <vector>

#include "slipfit/fit/result.hpp"

namespace slipfit::predict {

/// Models that the covariance of `model` allows, always the same ones: for what linear propagation cannot follow. Their
/// spread is normal and as wide as Student's t makes the intervals; what is no model is
/// left out: zeta outside [0, 1), static friction that falls with the stick time, a cut-off or rise below 0, numbers
/// that are not finite.
std::vector<ModelEstimate> draws_of(const ModelEstimate& model);

}  // namespace slipfit::predict
