#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "slipfit/predict/prediction.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit {

/// The information that a reader needs to repeat the fit of a sweep.
struct SweepOrigin {
  std::string name;          ///< of the group or the manifest
  std::string command_line;  ///< as typed; empty: not by command line
};

/// Writes one self-contained page of a speed sweep: shared parameters, spacing and friction against speed, the
/// prediction for each recording by a fit without it, and every trace. `prediction` is in ascending order of speed; if
/// it is empty, none is drawn between the recordings. Text from outside is escaped.
std::string to_html(std::span<const SweepEntry> entries, const SweepAnalysis& sweep,
                    const std::optional<Prediction>& prediction, const SweepOrigin& origin);

/// Returns the charts of the page of a sweep as `report_charts` of a recording does ("sweep-spacing", ...).
std::string report_charts(std::span<const SweepEntry> entries, const SweepAnalysis& sweep,
                          const std::optional<Prediction>& prediction, std::string_view which = {});

}  // namespace slipfit
