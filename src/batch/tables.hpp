#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "report/batch_html.hpp"
#include "slipfit/core/result.hpp"

// The rows of summary.csv and failures.csv, each a line without its end.

namespace slipfit::batch {

/// The entries of the manifest in a row of summary.csv; for a group `row` is its last row and `file` is empty.
struct SummaryKey {
  std::size_t row = 0;
  std::string id;
  std::string group;
  std::string file;
};

/// The line of names.
std::string summary_names();
/// Returns the row of a document of `slipfit fit --json`; unknown values are empty. Error: not_readable.
std::string summary_of_result(const SummaryKey& key, const std::string& document);
/// Returns the summary row of a recording that failed.
std::string summary_of_failure(const SummaryKey& key, const std::string& code);

/// The names and the row without `row`, as `slipfit::summary_columns` and `slipfit::summary_row` return them.
std::string summary_names_without_row();
std::string summary_without_row(const std::string& document);

/// The parts of a row of summary_of_... that a merge needs.
struct SummaryPlace {
  std::size_t row = 0;
  bool is_group = false;
  bool has_failed = false;
};
std::optional<SummaryPlace> place_of(const std::string& summary_line);

/// The line of names.
std::string failure_names();
std::string failure_line(const std::string& id, const Error& failure);
BatchPageFailure failure_from(const std::string& failure_line);

}  // namespace slipfit::batch
