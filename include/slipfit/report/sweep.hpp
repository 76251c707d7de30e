#pragma once

#include <span>
#include <string>

#include "slipfit/report/json.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit {

/// The document of a fit of a sweep: as that of one recording, with `recordings` in place of `recording`
/// (docs/formats.md). `options.id` names the group.
std::string to_json(std::span<const SweepEntry> entries, const SweepAnalysis& sweep, const JsonOptions& options = {});

/// The same on one screen, as `to_summary` of a recording.
std::string to_summary(std::span<const SweepEntry> entries, const SweepAnalysis& sweep, const std::string& name);

/// All results as text: shared parameters, the recordings over speed, what a fit without each of them predicts for it.
std::string to_text(std::span<const SweepEntry> entries, const SweepAnalysis& sweep, const std::string& name);

}  // namespace slipfit
