#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "slipfit/core/recording.hpp"
#include "slipfit/io/read_options.hpp"

namespace slipfit {

/// One row of a manifest: a recording, and all that is needed to read it.
struct ManifestEntry {
  std::string id;  ///< not empty, no slash, no control character, not of the form "group:..."
  std::filesystem::path file;
  std::filesystem::path surface;  ///< of the worn track; empty: none
  std::string group;              ///< empty: of no group
  Conditions conditions;
  ReadOptions options;
  std::size_t row = 0;   ///< 1, 2, ... over the recordings
  std::size_t line = 0;  ///< in the manifest, for messages; 0: of none
};

}  // namespace slipfit
