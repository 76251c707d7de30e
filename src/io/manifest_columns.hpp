#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/result.hpp"
#include "slipfit/io/manifest_entry.hpp"

namespace slipfit::reading {

struct ManifestField;

/// A column that is read: where it stands, what it is called, and what turns its numbers into SI.
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

/// From the names row, in the order in which their cells are to be read. `place` ("manifest.csv:1") begins each
/// message. Errors: missing_column, duplicate_column, unknown_unit.
Result<ManifestColumns> find_manifest_columns(const std::vector<std::string>& names, const std::string& place);

/// The entry with what a cell says about it. Errors: missing_value, bad_id, bad_number, out_of_range, bad_window,
/// unknown_unit, unknown_force_view, no_speed.
Result<ManifestEntry> with_cell(ManifestEntry entry, const ManifestColumn& column, const std::string& cell,
                                bool decimal_comma);

}  // namespace slipfit::reading
