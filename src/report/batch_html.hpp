#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "report/document/json_node.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit {

/// The row of a recording or group on the page of a batch.
struct BatchPageRow {
  std::string id;
  std::string status;                                     ///< as in the document: stick_slip, ...
  std::optional<double> speed_m_per_s;                    ///< empty for a group
  std::array<documents::DocumentQuantity, 5> quantities;  ///< frequency, spacing, stiffness, F_s - F_k, damping ratio
  std::vector<std::string> warnings;                      ///< their codes, each once
  std::string report_file;                                ///< of its own page, relative to the batch's; empty: none
  std::string sparkline;                                  ///< of `sparkline_of`; empty: none
};

/// Reads a document of schema slipfit.fit/1, one line of results.jsonl, without page and sparkline. Values that the
/// document does not contain are empty. Error: bad_document.
Result<BatchPageRow> batch_page_row(const std::string& document);

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

/// The trace in 60 columns as an SVG path, 120 wide and 26 high: at most 1 kB of digits, 'M', 'l', '-' and blanks.
std::string sparkline_of(const Recording& recording);

/// One self-contained page: a table to sort and to filter, distributions, failures. The tables hold the first 10 000
/// rows and say so; the distributions hold all. Text from outside stays text.
std::string to_html(const BatchPage& page);

}  // namespace slipfit
