#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "report/batch_html.hpp"
#include "slipfit/core/result.hpp"

// The rows of summary.csv and failures.csv, each a line without its end.

namespace slipfit::batch {

/// What the manifest says about a row of summary.csv; of a group `row` is its last one and `file` is empty.
struct SummaryKey {
  std::size_t row = 0;
  std::string id;
  std::string group;
  std::string file;
};

/// The line of names.
std::string summary_names();
/// From a document of `slipfit fit --json`; what it does not know is empty. Error: not_readable.
std::string summary_of_result(const SummaryKey& key, const std::string& document);
/// Returns the summary row of a recording that failed.
std::string summary_of_failure(const SummaryKey& key, const std::string& code);

/// These do what `slipfit::summary_columns` and `slipfit::summary_row` do.
std::string summary_names_without_row();
std::string summary_without_row(const std::string& document);

/// What a merge needs of a row that summary_of_... made.
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
