#pragma once

#include <optional>

#include "slipfit/core/recording.hpp"
#include "slipfit/fit/ring_down.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit {

/// The use of a recording in the fit of a sweep.
enum class SweepRole {
  Cycles,  ///< stick-slip: its cycles are fitted
  Steady,  ///< steady sliding: its mean force is F_k(V)
  LeftOut
};

/// One recording of a sweep (a speed, and possibly a load). The references must outlive the fit.
struct SweepRecording {
  const Recording& recording;
  const Quality& quality;
  const Segmentation& segmentation;
  SweepRole role = SweepRole::Cycles;
  std::optional<RingDown> ring_down{};  ///< that it shows, whatever its role
};

}  // namespace slipfit
