#pragma once

#include "slipfit/core/recording.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit::fit {

/// A recording as its fits see it. What it refers to outlives them.
struct FitInput {
  const Recording& recording;
  const Quality& quality;
  const Segmentation& segmentation;
  const HeldParameters& held;  ///< by the user, or by what is known besides the slips
};

/// The recording, as if it stated that its samples are averaged over this time.
Recording with_average(const Recording& recording, double average_s);

}  // namespace slipfit::fit
