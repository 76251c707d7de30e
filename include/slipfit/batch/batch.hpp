#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
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

/// Fits the recordings of a group together: one document on one line whose id is `id`. Called from several threads.
using GroupFit = std::function<Result<std::string>(const std::string& id, const std::vector<ManifestEntry>& members)>;

/// The joint fit (slipfit/sweep.hpp) as `slipfit fit --joint --json` writes it.
GroupFit group_fit(const FitOptions& options);

struct BatchOptions {
  std::filesystem::path manifest;
  std::filesystem::path folder;  ///< of the results; made where it is missing
  FitOptions fit;
  std::size_t jobs = 1;  ///< recordings at a time, >= 1
  bool resume = false;   ///< go on with what the folder holds
  Shard shard;
  GroupFit fit_group;  ///< empty: recordings on their own only
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
  std::function<bool()> should_stop;  ///< asked ten times a second; recordings in flight are still finished
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
/// Memory: the recordings in flight and at most 60 bytes a row. After a stop, an error or a kill at any moment, `resume`
/// goes on. Errors: those of ManifestReader, duplicate_id, empty_manifest, folder_in_use, folder_of_another_batch,
/// results_present, manifest_changed, cannot_write.
Result<BatchOutcome> run_batch(const BatchOptions& options, const BatchHooks& hooks = {});

/// Puts the finished shards of one batch together, in the manifest's order: the files that one machine would have
/// written. The progress counts their recordings. Errors: not_a_batch, not_finished, shards_differ, shards_missing,
/// folder_in_use, folder_of_another_batch, cannot_write.
Result<BatchProgress> merge_batches(const std::vector<std::filesystem::path>& shards,
                                    const std::filesystem::path& folder);

}  // namespace slipfit
