#pragma once

#include <optional>
#include <string>

#include "analysis/estimate.hpp"
#include "slipfit/analysis.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit {

struct Classification {
  MotionClass motion = MotionClass::Undetermined;
  std::string reason;
  bool dies_out = false;    ///< an oscillation that shrinks to steady sliding
  bool model_fits = false;  ///< the fitted cycles are the model's: its parameters mean something
  std::string caveat{};     ///< why no parameter is identified all the same; empty: no reason
};

/// Classifies the motion from slips, spectrum and fitted cycles. There is no fit if too few cycles could be fitted.
Classification classify(const Recording& recording, const Estimates& estimates);

/// A guess from the detected slips alone, where no fit was asked for.
Classification classify_by_shape(const Recording& recording, const Signals& signals);

}  // namespace slipfit
