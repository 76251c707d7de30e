#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <vector>

#include "batch/crew.hpp"
#include "batch/ledger.hpp"
#include "batch/pages.hpp"
#include "batch/work_list.hpp"
#include "slipfit/batch/batch.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit::batch {

/// The work of one call of run_batch: what has no result yet is fitted on several threads and put into the ledger.
class Run {
 public:
  /// All outlive the run.
  Run(const BatchOptions& options, const BatchHooks& hooks, const WorkList& list, Ledger& ledger);

  /// Each returns when all is done, or after a stop. Errors: those of ManifestReader, cannot_write.
  std::optional<Error> fit_recordings();
  std::optional<Error> fit_groups();

  [[nodiscard]] bool stopped() const { return stopped_; }
  [[nodiscard]] BatchProgress progress() const;

 private:
  using Clock = std::chrono::steady_clock;
  using Members = std::vector<ManifestEntry>;

  /// No result yet, or no page where there shall be one.
  [[nodiscard]] bool is_to_do(const PageKey& key) const;
  std::optional<Task> next_recording(ManifestReader& reader);
  std::optional<Task> task_for_group(std::size_t group, const Members& members);
  /// Of some groups, in the order of the work list.
  [[nodiscard]] Result<std::vector<Members>> members_of(std::size_t first_group, std::size_t count) const;
  void take_in(const PageKey& key, const Result<BatchFit>& fit);
  void keep(Error error);
  [[nodiscard]] std::optional<Error> first_error();
  Watch watch();

  const BatchOptions& options_;
  const BatchHooks& hooks_;
  const WorkList& list_;
  Ledger& ledger_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_sync_ = start_;
  std::size_t total_ = 0;
  std::size_t before_ = 0;
  std::atomic<std::size_t> fitted_ = 0;
  std::atomic<std::size_t> failed_ = 0;
  bool stopped_ = false;
  std::mutex error_mutex_;
  std::optional<Error> error_;  ///< the first that keeps the batch from going on
};

}  // namespace slipfit::batch
