#pragma once

#include <optional>

#include "slipfit/core/recording.hpp"

namespace slipfit {

/// What harmonics of about a frequency, on a straight level, leave of a few cycles at a time.
struct HarmonicResidual {
  double squares = 0.0;  ///< sum of them, in the unit of the force column
  double freedom = 0.0;  ///< samples less parameters

  [[nodiscard]] double rms() const;
};

/// The null model that stick-slip has to beat. Empty below 5 cycles.
std::optional<HarmonicResidual> residual_of_three_sines(const Recording& recording, double frequency_Hz);
/// With as many more. Of the same cycles.
std::optional<HarmonicResidual> residual_of_six_sines(const Recording& recording, double frequency_Hz);

}  // namespace slipfit
