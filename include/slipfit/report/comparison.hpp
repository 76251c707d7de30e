#pragma once

#include <string>
#include <vector>

#include "slipfit/analysis.hpp"
#include "slipfit/compare.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit {

/// Writes one document of the schema slipfit.compare/1 (docs/formats.md), without a trailing newline.
std::string to_json(const Comparison& comparison);

/// Writes a text for people: whether and in which quantities the sides differ, then every quantity.
std::string to_text(const Comparison& comparison);

/// A recording whose cycles a page shows.
struct ComparedRecording {
  Recording recording;
  Analysis analysis;
};

/// The information that a page shows in addition to the comparison.
struct ComparisonOrigin {
  std::string command_line;  ///< as typed; empty: not by command line
  /// The traces of the recordings; they are empty for result files, and the page then has no cycles.
  std::vector<ComparedRecording> recordings_a, recordings_b;
};

/// Writes one self-contained page: overlaid cycles of both sides, and the table.
std::string to_html(const Comparison& comparison, const ComparisonOrigin& origin);

}  // namespace slipfit
