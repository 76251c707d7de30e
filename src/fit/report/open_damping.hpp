#pragma once

#include "slipfit/fit/result.hpp"

namespace slipfit::fit {

/// The recordings say nothing of zeta: its interval is all of [0, 1].
bool is_damping_open(const FitResult& result);

/// Says of a fit with zeta held at 0 that the recordings say nothing of it.
void tell_open_damping(FitResult& result);

}  // namespace slipfit::fit
