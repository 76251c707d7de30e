#pragma once

#include "slipfit/fit/result.hpp"

namespace slipfit::fit {

/// Without every number that is not fixed by the user: the motion is not the model's stick-slip.
FitResult without_parameters(FitResult fit);

/// Cycles that keep in step with the mains: hum hides in them and changes what they tell. Where hum was found beside
/// them, or beside their second harmonic in step, nothing is identified; where none was, that there is none is taken
/// for granted, with a warning. The third harmonic does no harm (docs/accuracy.md).
FitResult qualified_by_mains(FitResult fit, double frequency_Hz, double duration_s);

}  // namespace slipfit::fit
