#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/estimate.hpp"
#include "slipfit/report/batch_html.hpp"

namespace slipfit::html {

/// One line of results.jsonl as the page shows it.
struct BatchEntry {
  std::string id;
  std::string status;
  std::optional<double> speed_m_per_s;
  Estimate frequency_Hz, spacing_m, stiffness_N_per_m, damping_ratio;
  std::size_t warnings = 0;
  std::string report_file;
  std::vector<double> sparkline;
};

/// Error `bad_document` where the row's document is no fit document.
Result<BatchEntry> batch_entry(const BatchPageRow& row);

/// <tr>
std::string batch_row(const BatchEntry& entry);

/// <thead> with a button for each column that sorts
std::string batch_headings();

}  // namespace slipfit::html
