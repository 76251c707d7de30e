#pragma once

#include "slipfit/fit/result.hpp"

namespace slipfit::fit {

/// Returns the result without every number that is not fixed by the user: the motion is not the model's stick-slip.
FitResult without_parameters(FitResult fit);

/// Qualifies the result of cycles that keep in step with the mains: hum is not visible in them and changes their
/// estimates. Where hum was found next to them, or next to their second harmonic in step, nothing is identified; where
/// none was found, it is assumed to be absent, with a warning. The third harmonic does no harm (docs/accuracy.md).
FitResult qualified_by_mains(FitResult fit, double frequency_Hz, double duration_s);

/// Slips far slower than the rig's own free ring-down may not be inertial: friction that weakens slowly or a viscous
/// film sets their time, unless what rings is lighter than the body that slips. Natural frequency, mass and damping are
/// weak; where the slips do not follow the model either (warning model_misfit) they are unknown, and F_s - F_k lies
/// between half of the drop (no damping) and all of it. `force_drop`: unit of the force column.
FitResult qualified_by_ring_down(FitResult fit, double ring_down_frequency_Hz, double force_drop);

}  // namespace slipfit::fit
