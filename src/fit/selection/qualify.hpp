#pragma once

#include "slipfit/fit/result.hpp"

namespace slipfit::fit {

/// Without every number that is not fixed by the user: the motion is not the model's stick-slip.
FitResult without_parameters(FitResult fit);

/// Cycles that keep in step with the mains: hum hides in them and changes what they tell. Where hum was found beside
/// them, or beside their second harmonic in step, nothing is identified; where none was, that there is none is taken
/// for granted, with a warning. The third harmonic does no harm (docs/accuracy.md).
FitResult qualified_by_mains(FitResult fit, double frequency_Hz, double duration_s);

/// Slips far slower than the rig's own free ring-down are not inertial: the fit's natural frequency is that of
/// something else (friction that weakens slowly, a viscous film), and so are mass and damping. F_s - F_k lies between
/// half of the drop (no damping) and all of it. `force_drop`: unit of the force column.
FitResult qualified_by_ring_down(FitResult fit, double ring_down_frequency_Hz, double force_drop);

}  // namespace slipfit::fit
