#pragma once

#include <string>

#include "slipfit/analysis.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit {

enum class JsonLayout { Indented, OneLine };

struct JsonOptions {
  std::string id;                            ///< empty: the file's name without its ending
  bool timing = false;                       ///< only with timing do two runs differ
  JsonLayout layout = JsonLayout::Indented;  ///< OneLine: for a file with one result a line
};

/// Writes one document of the schema slipfit.fit/1 (docs/fit.schema.json), without a trailing newline. It is valid
/// UTF-8 without NaN and infinity: unknown or infinite numbers are null.
std::string to_json(const Recording& recording, const Analysis& analysis, const JsonOptions& options = {});

}  // namespace slipfit
