#pragma once

#include <optional>
#include <span>
#include <string>

#include "slipfit/predict/prediction.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit {

/// What a reader needs to repeat a fit of a sweep.
struct SweepOrigin {
  std::string name;          ///< of the group or the manifest
  std::string command_line;  ///< as typed; empty: not by command line
};

/// One self-contained page of a speed sweep: shared parameters, spacing and friction over speed, what a fit without
/// each recording predicts for it, and every trace. `prediction`: over speed, ascending; empty: none is drawn between
/// the recordings. Text from outside stays text.
std::string to_html(std::span<const SweepEntry> entries, const SweepAnalysis& sweep,
                    const std::optional<Prediction>& prediction, const SweepOrigin& origin);

}  // namespace slipfit
