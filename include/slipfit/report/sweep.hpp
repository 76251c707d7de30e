#pragma once

#include <span>
#include <string>

#include "slipfit/report/json.hpp"
#include "slipfit/report/text.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit {

/// Writes the document of a fit of a sweep: as that of one recording, with `recordings` instead of `recording`
/// (docs/formats.md). `options.id` names the group.
std::string to_json(std::span<const SweepEntry> entries, const SweepAnalysis& sweep, const JsonOptions& options = {});

/// Writes the summary of a sweep on one screen, like `to_summary` of a recording.
std::string to_summary(std::span<const SweepEntry> entries, const SweepAnalysis& sweep, const std::string& name,
                       const SummaryHints& hints = {});

/// Writes all results as text: shared parameters, the recordings against speed, and the prediction for each of them by
/// a fit without it.
std::string to_text(std::span<const SweepEntry> entries, const SweepAnalysis& sweep, const std::string& name);

}  // namespace slipfit
