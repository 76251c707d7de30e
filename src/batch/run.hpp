#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "batch/process_pool.hpp"
#include "batch/result_log.hpp"
#include "batch/work_list.hpp"
#include "batch/worker.hpp"
#include "slipfit/batch/options.hpp"

namespace slipfit::batch {

/// The work of one call of run_batch: what has no result yet, or one of other bytes, is fitted in several processes and
/// put into the log.
class Run {
 public:
  /// Starts a run; all arguments outlive it.
  Run(const BatchOptions& options, const BatchHooks& hooks, const WorkList& list, ResultLog& log);
  /// Fits that are at work end with it.
  ~Run() { end(); }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;
  Run(Run&&) = delete;
  Run& operator=(Run&&) = delete;

  /// Returns when all is done, or after a stop. Errors: those of ManifestReader, cannot_write.
  void fit_all();

  [[nodiscard]] bool stopped() const { return stopped_; }
  [[nodiscard]] BatchProgress progress() const;

 private:
  using Clock = std::chrono::steady_clock;
  using Members = std::vector<ManifestEntry>;

  void fit_recordings();
  /// Says which recordings were replaced, or are gone, since they were fitted.
  void notify_of_replaced() const;
  void fit_groups(std::size_t first_group, std::size_t count);
  /// Returns the members of several groups in the order of the work list.
  [[nodiscard]] std::vector<Members> members_of(std::size_t first_group, std::size_t count) const;
  void offer(WorkItem item);
  void finish();
  void end();
  void begin(WorkItem item);
  void wait_and_watch();
  void take_answers();
  void wait_for_begun();
  [[nodiscard]] double limit_of(const WorkItem& item) const;
  void take(const WorkItem& item, const Answer& answer);
  void take_result(std::size_t slot, std::string_view document);
  void take_failure(const WorkItem& item, const Error& failure);

  const BatchOptions& options_;
  const BatchHooks& hooks_;
  const WorkList& list_;
  ResultLog& log_;
  reading::KeptFile kept_;  ///< of the process that fits
  ProcessPool pool_;
  std::map<std::size_t, WorkItem> at_work_;  ///< by the number of the job
  std::vector<WorkItem> suspects_;           ///< whose process died: tried again when nothing else runs
  std::map<std::size_t, unsigned> deaths_;   ///< in this run, by slot
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_sync_ = start_;
  BatchProgress counts_;
  std::vector<std::string> replaced_, gone_;  ///< ids
  bool stopped_ = false;
};

}  // namespace slipfit::batch
