#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/result.hpp"
#include "slipfit/fit/fit.hpp"
#include "slipfit/io/manifest.hpp"

namespace slipfit {

/// The part of a manifest that one machine takes: `index` of `count`, from 1. Parts are balanced by file size.
struct Shard {
  std::size_t index = 1;
  std::size_t count = 1;
};

/// A page of the batch, and in the folder `recordings` beside it one of each recording and group (docs/report.md). A
/// shard writes the latter alone: shards may share the folder.
struct BatchReport {
  std::filesystem::path file;  ///< in a folder that is there, or can be made
  std::string command_line;    ///< that the pages show: how to repeat them
};

/// What a batch keeps of a recording or a group.
struct BatchFit {
  std::string document;   ///< schema slipfit.fit/1, on one line
  std::string page;       ///< HTML; empty: none
  std::string sparkline;  ///< the trace as a small SVG path; empty: none
};

/// Fits the recordings of a group together; the document's id is `id`. Called in other processes.
using GroupFit = std::function<Result<BatchFit>(const std::string& id, const std::vector<ManifestEntry>& members)>;

/// The joint fit (slipfit/sweep.hpp) as `slipfit fit --joint --json` writes it, with its page where there is a report.
GroupFit group_fit(const FitOptions& options, const std::optional<BatchReport>& report);

struct BatchOptions {
  std::filesystem::path manifest;
  std::filesystem::path folder;  ///< of the results; made where it is missing
  FitOptions fit;
  std::size_t jobs = 1;      ///< recordings at a time, >= 1
  double timeout_s = 600.0;  ///< of a recording; a group has that of its recordings together
  bool resume = false;       ///< go on with what the folder holds
  Shard shard;
  GroupFit fit_group;  ///< empty: recordings on their own only
  std::optional<BatchReport> report;
};

struct BatchProgress {
  std::size_t total = 0;   ///< recordings and groups of this shard
  std::size_t before = 0;  ///< done by the run that is resumed
  std::size_t fitted = 0;  ///< by this run
  std::size_t failed = 0;  ///< by this run
  double seconds = 0.0;    ///< since this run began
};

/// How a batch talks to its caller; each may be empty. All are called from the thread that called run_batch.
struct BatchHooks {
  std::function<bool()>
      should_stop;  ///< asked ten times a second; recordings in flight have a second to come to their end
  std::function<void(const BatchProgress&)> show_progress;
  std::function<void(const std::string&)> tell;
};

enum class BatchEnd { Finished, Stopped };

struct BatchOutcome {
  BatchEnd end = BatchEnd::Finished;
  BatchProgress progress;
};

/// Fits every recording of a manifest on its own (and every group together) and writes results.jsonl, summary.csv,
/// failures.csv and run.json as docs/formats.md says. A recording that fails is a row of failures.csv and no error.
/// Fits run in child processes (fork): the calling process should have no other threads at work. One that crashes,
/// hangs or takes too much memory fails alone. Memory: the recordings in flight and at most 80 bytes a row, with a
/// report 1.5 kB. After a stop, an error or a kill at any moment, `resume` goes on; what was fitted of other bytes than
/// a file holds now is fitted again. Errors: those of ManifestReader, duplicate_id, empty_manifest, folder_in_use,
/// folder_of_another_batch, results_present, manifest_changed, not_a_page, cannot_write.
Result<BatchOutcome> run_batch(const BatchOptions& options, const BatchHooks& hooks = {});

/// Puts the finished shards of one batch together, in the manifest's order: the files that one machine would have
/// written. The progress counts their recordings. Errors: not_a_batch, not_finished, not_as_written, shards_differ,
/// shards_missing, folder_in_use, folder_of_another_batch, cannot_write.
Result<BatchProgress> merge_batches(const std::vector<std::filesystem::path>& shards,
                                    const std::filesystem::path& folder);

}  // namespace slipfit
