#pragma once

#include <string>
#include <vector>

#include "slipfit/analysis.hpp"
#include "slipfit/compare.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit {

/// One document of the schema slipfit.compare/1 (docs/formats.md), without a trailing newline.
std::string to_json(const Comparison& comparison);

/// For people: whether and in what the two sides differ, then every quantity.
std::string to_text(const Comparison& comparison);

/// A recording whose cycles a page shows.
struct ComparedRecording {
  Recording recording;
  Analysis analysis;
};

/// What a page shows beside the comparison.
struct ComparisonOrigin {
  std::string command_line;  ///< as typed; empty: not by command line
  /// Of result files there are none, and the page has no cycles.
  std::vector<ComparedRecording> recordings_a, recordings_b;
};

/// One self-contained page: cycles of both sides over each other, and the table.
std::string to_html(const Comparison& comparison, const ComparisonOrigin& origin);

}  // namespace slipfit
