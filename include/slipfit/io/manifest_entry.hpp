#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"
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

/// A cell of a manifest by the name of its column.
struct NamedCell {
  std::string column;
  std::string text;
};

/// What a row of these cells says, for programs that take it as text; no column is needed. Beside what a manifest
/// understands, `speed` may be a rotation where `radius` stands beside it, and `speed_se` a percentage of the speed.
/// Errors: unknown_option and those of the cells of a manifest; the message begins with the column.
Result<ManifestEntry> entry_from_cells(std::span<const NamedCell> cells);

}  // namespace slipfit
