#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/result.hpp"
#include "slipfit/fit/fit.hpp"
#include "slipfit/io/manifest_entry.hpp"

namespace slipfit {

/// The part of a manifest that one machine takes: `index` of `count`, from 1. Parts take the rows in turn.
struct Shard {
  std::size_t index = 1;
  std::size_t count = 1;
};

/// The pages of a batch: one of the batch, and one of each recording and group in the folder `recordings` next to it
/// (docs/report.md). A shard writes only the latter, so that shards may share the folder.
struct BatchReport {
  std::filesystem::path file;  ///< its folder is made where it is missing
  std::string command_line;    ///< shown on the pages: how to repeat them
};

/// The results of a recording or a group that a batch keeps.
struct BatchFit {
  std::string document;   ///< schema slipfit.fit/1, on one line
  std::string page;       ///< HTML; empty: none
  std::string sparkline;  ///< the trace as a small SVG path; empty: none
};

/// Fits the recordings of a group together; the document gets the id `id`. The function is called in child processes.
using GroupFit = std::function<Result<BatchFit>(const std::string& id, const std::vector<ManifestEntry>& members)>;

/// Returns a function that fits the sweep (slipfit/sweep.hpp) and writes it like `slipfit fit --joint --json`, with its
/// page if there is a report.
GroupFit group_fit(const FitOptions& options, const std::optional<BatchReport>& report);

/// Recordings at a time that keep busy every processor that this process may use: affinity and control groups limit
/// them.
[[nodiscard]] std::size_t default_jobs();

struct BatchOptions {
  std::filesystem::path manifest;
  std::filesystem::path folder;  ///< of the results; made where it is missing
  FitOptions fit;
  std::size_t jobs = 1;      ///< recordings at a time, >= 1
  double timeout_s = 600.0;  ///< of a recording; a group has that of its recordings together
  bool resume = false;       ///< continue with what the folder holds
  Shard shard;
  GroupFit fit_group;  ///< empty: groups are not fitted
  std::optional<BatchReport> report;
};

struct BatchProgress {
  std::size_t total = 0;   ///< recordings and groups of this shard
  std::size_t before = 0;  ///< done by the run that is resumed
  std::size_t fitted = 0;  ///< by this run
  std::size_t failed = 0;  ///< by this run
  double seconds = 0.0;    ///< since this run began
};

/// Functions through which a batch reports to its caller; each may be empty. All are called from the thread that called
/// run_batch.
struct BatchHooks {
  /// Asked ten times per second; if it returns true, running fits have one second to end.
  std::function<bool()> should_stop;
  /// Asked as often; if it returns true, the batch and its processes stop until the calling process is continued.
  std::function<bool()> should_suspend;
  std::function<void(const BatchProgress&)> show_progress;
  std::function<void(const std::string&)> notify;
};

enum class BatchEnd { Finished, Stopped };

struct BatchOutcome {
  BatchEnd end = BatchEnd::Finished;
  BatchProgress progress;
};

}  // namespace slipfit
