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
/// `id`, `file` and `speed_m_per_s` must be there; the name may contain a unit (`speed [mm/s]`, `speed_mm_per_s`).
/// Files are relative to the manifest. Every error is one line: file, line, column, value, what was expected.
class ManifestReader {
 public:
  /// Opens a manifest. Errors: those of opening a text file, missing_column, duplicate_column, unknown_unit.
  static Result<ManifestReader> open(const std::filesystem::path& file);

  /// Returns the next recording, or nothing after the last one. An error concerns its row only: the next call continues
  /// after it (except after not_readable, which ends the manifest). Errors: wrong_field_count, open_quote,
  /// missing_value, bad_id, bad_number, out_of_range, bad_window, unknown_unit, unknown_force_view, not_readable.
  Result<std::optional<ManifestEntry>> next();

  /// Returns the names of columns that are not used.
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

/// Returns the recordings of one group (or all, without a group) in the order of the manifest. Errors: those of
/// ManifestReader in any row, duplicate_id, unknown_group, empty_manifest.
Result<std::vector<ManifestEntry>> read_manifest_group(const std::filesystem::path& file,
                                                       const std::optional<std::string>& group);

/// Returns the error with a remedy that names columns of the manifest instead of options.
Error in_words_of_manifest(Error error);

}  // namespace slipfit
