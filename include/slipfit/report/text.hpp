#pragma once

#include <string>

#include "slipfit/analysis.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit {

/// Says how a reader of a summary finds the rest: by options of the command, unless stated otherwise.
struct SummaryHints {
  std::string details = "--details";  ///< of all warnings
  std::string all = "all results: --details or --json      page with charts: --report FILE.html";
};

/// Writes the summary, on one screen: at most 25 lines of 100 characters with the kind of motion, parameters, spacing
/// and critical speed with intervals and statuses, and the warnings with the largest effect.
std::string to_summary(const Recording& recording, const Analysis& analysis, const SummaryHints& hints = {});

/// Writes the summary of a document of the schema slipfit.fit/1, of a recording or a sweep, as above; messages call the
/// document `name`. Error: bad_document.
Result<std::string> summary_of_document(const std::string& content, const std::string& name,
                                        const SummaryHints& hints = {});

/// Writes all results as text: kind of motion, parameters with intervals and status, spacing (measured, separate from
/// predicted), warnings.
std::string to_text(const Recording& recording, const Analysis& analysis);

}  // namespace slipfit
