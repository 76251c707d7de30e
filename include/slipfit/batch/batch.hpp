#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "slipfit/batch/options.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit {

/// Fits every recording of a manifest on its own (and every group together) and writes results.jsonl, summary.csv,
/// failures.csv and run.json as docs/formats.md says. A recording that fails is a row of failures.csv and no error.
/// Fits run in child processes (fork): the calling process should have no other threads at work. Where one crashes,
/// hangs or takes too much memory, its recording alone fails. Memory: the recordings being fitted and some 80 bytes
/// a row, with a report 1.5 kB. After a stop, an error or a kill at any moment, `resume` continues; a recording whose
/// file has changed since its fit is fitted again. Errors: those of ManifestReader, duplicate_id, empty_manifest,
/// folder_in_use, folder_of_another_batch, results_present, manifest_changed, not_a_page, cannot_write.
Result<BatchOutcome> run_batch(const BatchOptions& options, const BatchHooks& hooks = {});

/// Merges the finished shards of one batch, in the order of the manifest, into the files that one machine would have
/// written. The progress counts their recordings. Errors: not_a_batch, not_finished, not_as_written, shards_differ,
/// shards_missing, folder_in_use, folder_of_another_batch, cannot_write.
Result<BatchProgress> merge_batches(const std::vector<std::filesystem::path>& shards,
                                    const std::filesystem::path& folder);

/// Returns the column names of summary.csv, except `row`, as a line of CSV.
std::string summary_columns();

/// Returns the row of summary.csv for a fit document, as a line of CSV without `row`; group and file are those of its
/// recording. Messages call the document `name`. Errors: those of check_fit_document.
Result<std::string> summary_row(const std::string& document, const std::string& name);

}  // namespace slipfit
