#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/io/read_options.hpp"

namespace slipfit {

/// One row of a manifest: a recording, and everything that is needed to read it.
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

/// A property of a recording that a column of a manifest or an option of the command line can state.
struct RecordingOption {
  enum class Of { Conditions, Reading, Pieces };
  std::string_view column;    ///< without its unit: "speed"
  std::string_view option{};  ///< "--speed", "--sensor-average,--averaging"; "--segments{yes}": a flag and what it says
  std::string_view help{};
  Of of = Of::Conditions;

  /// Returns the name of the option: "--strokes" of "--strokes{both}", the first of several spellings.
  [[nodiscard]] constexpr std::string_view name() const { return option.substr(0, option.find_first_of(",{")); }
};

/// Returns the options of every command that reads a recording.
std::vector<RecordingOption> recording_options();

/// A cell of a manifest by the name of its column.
struct NamedCell {
  std::string column;
  std::string text;
  std::string place = {};  ///< begins messages about it; empty: the column
};

/// Returns the entry that a row with these cells states, for programs that state it as text; no column is required.
/// Errors: unknown_option and those of the cells of a manifest.
Result<ManifestEntry> entry_from_cells(std::vector<NamedCell> cells);

}  // namespace slipfit
