#pragma once

#include <string>

#include "fit/inference/ageing_line.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/fit/parameter.hpp"

namespace slipfit::fit {

/// What it would take to know zeta well enough. Its errors fall with the root of the cycles; identified from a quarter
/// on.
std::string weak_damping(const Estimate& damping);

/// The cut-off of ageing, where the recordings do not tell it: the part of its range that they allow.
Parameter held_cutoff(const AgeingCutoff& cutoff, double stick_s);

}  // namespace slipfit::fit
