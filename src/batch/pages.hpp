#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "batch/result_log.hpp"
#include "batch/work_list.hpp"
#include "slipfit/batch/options.hpp"

// The pages of a batch. That of a recording is written when it is fitted; its last line says to which document it
// belongs and holds the sparkline, so that the index can be made at any time from results.jsonl and the pages.

namespace slipfit::batch {

/// Prepares the pages. Errors: cannot_write; not_a_page if the index would replace a file that is not a page.
void prepare_pages(const BatchReport& report);

/// Writes the page of a recording or group. Errors: as above.
void write_page(const BatchReport& report, const SlotKey& key, const BatchFit& fit);

/// Removes what a process left that was killed while it wrote this page, if it left anything.
void remove_unfinished_page(const BatchReport& report, const SlotKey& key);

/// Returns the small trace of a page, or nothing if no page belongs to the document.
std::optional<std::string> sparkline_on_page(const BatchReport& report, const SlotKey& key, std::string_view document);

/// Writes the index of the results in the log, in the order of the manifest. Errors: those of ManifestReader,
/// cannot_write, not_a_page.
void write_index(const BatchReport& report, const std::filesystem::path& manifest, const WorkList& list,
                 const ResultLog& log);

}  // namespace slipfit::batch
