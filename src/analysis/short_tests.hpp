#pragma once

#include <vector>

#include "slipfit/analysis.hpp"

namespace slipfit {

/// One-line tests of what the fit takes for granted (docs/accuracy.md): drift of the period, a cycle against the one
/// before, ageing; the stated mass and the load cell's resonance where they are stated; without a fit, whether the
/// level repeats. Empty unless the kind of motion is stick-slip.
std::vector<ShortTest> run_short_tests(const Recording& recording, const Analysis& analysis);

/// One warning for each test whose outcome is beyond chance (1 in 1000).
Warnings warn_of(const std::vector<ShortTest>& tests);

}  // namespace slipfit
