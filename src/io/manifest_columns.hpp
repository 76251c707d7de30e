#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "slipfit/core/units.hpp"
#include "slipfit/io/manifest_entry.hpp"

namespace slipfit::reading {

/// A property of a recording that can be stated: one table for manifests, the command line and programs that state it
/// as text.
struct ManifestField {
  enum class Bound { AboveZero, NotNegative, None };
  enum class Need { Nothing, Column, Value };  ///< of a manifest
  using SetNumber = void(ManifestEntry&, double);
  using SetText = std::optional<Error>(ManifestEntry&, const std::string&);

  RecordingOption said;
  std::string_view suffix{};             ///< behind the column's name: its SI unit
  std::optional<Dimension> dimension{};  ///< empty: text
  Bound bound = Bound::None;
  SetNumber* set_number = nullptr;  ///< nothing and `dimension`: a window
  SetText* set_text = nullptr;
  Need need = Need::Nothing;

  [[nodiscard]] std::string full_name() const { return std::string(said.column) + std::string(suffix); }
};

std::span<const ManifestField> manifest_fields();

/// The text with the manifest's columns in place of the options of the command line that say the same.
std::string with_columns_for_options(std::string text);

/// A column that is read: its position, its name, and its conversion to SI.
struct ManifestColumn {
  const ManifestField* field = nullptr;
  std::size_t index = 0;
  std::string name;             ///< as in the file
  std::optional<double> scale;  ///< empty: no unit in the name, then a number is in SI or brings its unit
  std::string unit;             ///< in the name, other than SI
};

struct ManifestColumns {
  std::vector<ManifestColumn> read;
  std::vector<std::string> ignored;
  std::size_t count = 0;  ///< of all columns
};

/// Finds the columns in the header line, in the order in which their cells have to be read. `place` ("manifest.csv:1")
/// starts each message. Errors: missing_column, duplicate_column, unknown_unit.
Result<ManifestColumns> find_manifest_columns(const std::vector<std::string>& names, const std::string& place);

/// The entry with what a cell says about it. Errors: missing_value, bad_id, bad_number, out_of_range, bad_window,
/// unknown_unit, unknown_force_view, unknown_drift, bad_sensor_filter, conflicting_sensor, no_speed.
Result<ManifestEntry> with_cell(ManifestEntry entry, const ManifestColumn& column, const std::string& cell,
                                bool decimal_comma);

}  // namespace slipfit::reading
