#include "slipfit/batch/batch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <system_error>
#include <utility>

#include "batch/folder.hpp"
#include "batch/pages.hpp"
#include "batch/result_log.hpp"
#include "batch/run.hpp"
#include "batch/run_file.hpp"
#include "batch/tables.hpp"
#include "batch/work_list.hpp"
#include "core/platform.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/report/fit_document.hpp"

namespace slipfit {
namespace {

using namespace batch;

/// Begins the journal and run.json, in an order that is safe against a kill at any moment: a finished batch stays one
/// until its results are in the journal, and run.json is there before any other file.
std::size_t prepare_folder(const BatchOptions& options, const WorkList& list, const RunRecord& now,
                           const std::optional<RunRecord>& before) {
  if (before && !options.resume && has_results(options.folder, *before)) {
    throw file_error("results_present", options.folder,
                     "contains results of this batch; continue with --resume, or choose another folder with --out");
  }
  if (!before) write_record(options.folder, now);
  const bool continues_journal = before && !before->finished;
  const std::size_t damaged = continues_journal ? 0 : begin_journal(options.folder, before ? &*before : nullptr, list);
  write_record(options.folder, now);
  std::error_code ignored;
  std::filesystem::remove(options.folder / kSummary, ignored);  // of an earlier run; written again at the end
  return damaged;
}

void notify_of_damaged(const BatchHooks& hooks, std::size_t count, const char* file) {
  if (count == 0 || !hooks.notify) return;
  hooks.notify(fmt::format("{} results in {} were changed or damaged and are fitted again", count, file));
}

void report_other_processor(const BatchHooks& hooks, const RunRecord& before, const RunRecord& now) {
  if (!hooks.notify || before.processor == now.processor) return;
  hooks.notify(fmt::format("some results were computed on another processor ({}; this one: {}): last digits may differ",
                           printable(before.processor), now.processor));
}

void notify_of_ignored_columns(const BatchOptions& options, const BatchHooks& hooks, const WorkList& list) {
  if (!hooks.notify || list.ignored_columns.empty()) return;
  hooks.notify(fmt::format("{}: columns that are not used: {}", printable(options.manifest.string()),
                           fmt::join(list.ignored_columns, ", ")));
}

/// Rows are identified by their number, so that the manifest must be the same from the first reading to the last.
void check_unchanged(const BatchOptions& options, const WorkList& list) {
  const auto digest = manifest_digest(options.manifest);
  if (digest && digest.value() == list.manifest_digest) return;
  throw file_error("manifest_changed", options.manifest,
                   "was edited while the batch ran; restore it and continue with --resume");
}

/// Whatever happened before, what is done is on the disk and run.json says how far it came.
void close(const BatchOptions& options, const WorkList& list, const Run& run, ResultLog& log, RunRecord record) {
  log.sync();
  log.throw_error();
  if (!run.stopped()) {
    check_unchanged(options, list);
    record.digests = write_final_files(options.folder, options.manifest, list, log);
    if (options.report && options.shard.count == 1) write_index(*options.report, options.manifest, list, log);
  }
  record.progress = run.progress();
  record.finished = !run.stopped();
  write_record(options.folder, record);
  if (record.finished) remove_journal(options.folder);
}

BatchOutcome run_or_throw(const BatchOptions& options, const BatchHooks& hooks) {
  const WorkList list = list_work(options);
  const FolderLock lock = FolderLock::take(options.folder);
  if (options.report) prepare_pages(*options.report);
  RunRecord record = begin_record(options, list.manifest_digest, list.rows);
  const std::optional<RunRecord> before = check_folder(options.folder, record);
  if (before) report_other_processor(hooks, *before, record);
  if (before) record.processor = processors_of(*before, record);
  notify_of_damaged(hooks, prepare_folder(options, list, record, before), kResults);
  notify_of_ignored_columns(options, hooks, list);
  ResultLog log(options.folder, list.is_mine.size());
  log.throw_error();
  notify_of_damaged(hooks, log.damaged(), kJournal);
  Run run(options, hooks, list, log);
  run.fit_all();
  close(options, list, run, log, record);
  return {run.stopped() ? BatchEnd::Stopped : BatchEnd::Finished, run.progress()};
}

}  // namespace

std::size_t default_jobs() {
  return platform::processors();
}

Result<BatchOutcome> run_batch(const BatchOptions& options, const BatchHooks& hooks) {
  return result_of([&] { return run_or_throw(options, hooks); });
}

std::string summary_columns() {
  return summary_names_without_row();
}

Result<std::string> summary_row(const std::string& document, const std::string& name) {
  if (const auto error = check_fit_document(document, name)) return *error;
  return result_of([&] { return summary_without_row(document); });
}

}  // namespace slipfit
