#pragma once

#include <string>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit {

/// One recording of a batch.
struct BatchPageRow {
  std::string document;           ///< schema slipfit.fit/1, one line of results.jsonl
  std::string report_file;        ///< of its own page, relative to the batch's; empty: none
  std::vector<double> sparkline;  ///< of `sparkline_of`; empty: none
};

/// One row of failures.csv.
struct BatchPageFailure {
  std::string id;
  std::string code;
  std::string message;
};

struct BatchPage {
  std::string title;
  std::vector<BatchPageRow> rows;  ///< in the order of the manifest
  std::vector<BatchPageFailure> failures;
};

/// The trace as 120 numbers at most: the lowest and the highest of each piece.
std::vector<double> sparkline_of(const Recording& recording);

/// One self-contained page: a table to sort and to filter, distributions, failures. The table holds the first 5000 rows
/// and says so; the distributions hold all. Text from outside stays text. Error `bad_document` where a row is no fit
/// document.
Result<std::string> to_html(const BatchPage& page);

}  // namespace slipfit
