#pragma once

#include "slipfit/core/estimate.hpp"

namespace test {

/// Returns whether the estimate has an interval that holds the true value.
inline bool holds(const slipfit::Estimate& estimate, double truth) {
  return estimate.ci95 && estimate.ci95->low <= truth && truth <= estimate.ci95->high;
}

}  // namespace test
