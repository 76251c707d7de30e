#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/result.hpp"
#include "slipfit/io/manifest_entry.hpp"

namespace slipfit {

/// Reads a manifest row by row, in memory that does not depend on its length. docs/formats.md lists the columns:
/// `id`, `file` and `speed_m_per_s` must be there; a unit may stand in the name (`speed [mm/s]`, `speed_mm_per_s`).
/// Files are relative to the manifest. Every error is one line: file, line, column, value, what was expected.
class ManifestReader {
 public:
  /// Errors: those of opening a text file, missing_column, duplicate_column, unknown_unit.
  static Result<ManifestReader> open(const std::filesystem::path& file);

  /// The next recording; nothing behind the last one. Errors: wrong_field_count, open_quote, missing_value, bad_id,
  /// bad_number, out_of_range, bad_window, unknown_unit, unknown_force_view, not_readable. An error is about its row
  /// only: the next call goes on behind it (but after not_readable, where nothing follows).
  Result<std::optional<ManifestEntry>> next();

  /// Columns that mean nothing here, as they are called in the file.
  [[nodiscard]] const std::vector<std::string>& ignored_columns() const;

  ManifestReader(ManifestReader&&) noexcept;
  ManifestReader& operator=(ManifestReader&&) noexcept;
  ManifestReader(const ManifestReader&) = delete;
  ManifestReader& operator=(const ManifestReader&) = delete;
  ~ManifestReader();

 private:
  class Implementation;
  explicit ManifestReader(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

/// The recordings of one group (or all, without a group), in the manifest's order. Errors: those of ManifestReader in
/// any row, duplicate_id, unknown_group, empty_manifest.
Result<std::vector<ManifestEntry>> read_manifest_group(const std::filesystem::path& file,
                                                       const std::optional<std::string>& group);

/// The error of a recording whose manifest must say more: the remedy names the manifest's columns in place of options.
Error in_words_of_manifest(Error error);

}  // namespace slipfit
