#pragma once

#include <optional>

#include "slipfit/core/recording.hpp"

namespace slipfit {

/// Root mean square of what three harmonics of about this frequency, on a straight level, leave of a few cycles at a
/// time, in the unit of the force column: the null model that stick-slip has to beat. Empty below 5 cycles.
std::optional<double> harmonic_residual_rms(const Recording& recording, double frequency_Hz);

/// The share of the variance about a straight level that a sine of about this frequency explains, a few cycles at a
/// time. About 0 where the force is noise. Empty below 5 cycles.
std::optional<double> share_of_sine(const Recording& recording, double frequency_Hz);

}  // namespace slipfit
