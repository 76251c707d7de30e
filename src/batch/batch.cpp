#include "slipfit/batch/batch.hpp"

#include <fmt/format.h>

#include <memory>
#include <system_error>
#include <utility>

#include "batch/final_files.hpp"
#include "batch/folder_check.hpp"
#include "batch/folder_lock.hpp"
#include "batch/pages.hpp"
#include "batch/result_log.hpp"
#include "batch/run.hpp"
#include "batch/run_file.hpp"
#include "batch/work_list.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {
namespace {

using namespace batch;

/// Opens the log of results and writes run.json. Whatever moment a kill comes: the folder is ours by its run.json
/// before any other file is in it, and lines that were found are in the journal before run.json says that they are not
/// all.
Result<std::unique_ptr<ResultLog>> open_log(const BatchOptions& options, const BatchHooks& hooks, const WorkList& list,
                                            const RunRecord& now) {
  const auto before = check_folder(options.folder);
  if (!before) return before.error();
  if (auto error = check_same_batch(options.folder, before.value(), now)) return *error;
  const bool goes_on = before.value() && !difference(*before.value(), now);
  if (goes_on && !options.resume && has_results(options.folder)) {
    return Error{"results_present", one_line(options.folder.string()) +
                                        ": holds results of this batch; go on with --resume, or choose another "
                                        "folder with --out"};
  }
  const std::size_t slots = list.is_mine.size();
  FoundResults found = goes_on ? find_results(options.folder, *before.value(), slots, list.slots) : no_results(slots);
  if (found.damaged > 0 && hooks.tell) {
    hooks.tell(
        fmt::format("{} results are not in results.jsonl as they were written, and are fitted again", found.damaged));
  }
  if (!goes_on) {
    if (auto error = write_record(options.folder, now)) return *error;
  }
  if (auto error = write_journal(options.folder, found)) return *error;
  if (auto error = write_record(options.folder, now)) return *error;
  return ResultLog::open(options.folder, std::move(found));
}

void tell_ignored_columns(const BatchOptions& options, const BatchHooks& hooks) {
  const auto reader = ManifestReader::open(options.manifest);
  if (!hooks.tell || !reader || reader.value().ignored_columns().empty()) return;
  hooks.tell(fmt::format("{}: columns that are not used: {}", one_line(options.manifest.string()),
                         fmt::join(reader.value().ignored_columns(), ", ")));
}

/// Rows are told apart by their number, so that the manifest must be the same from the first look to the last.
std::optional<Error> check_unchanged(const BatchOptions& options, const WorkList& list) {
  const auto digest = manifest_digest(options.manifest);
  if (digest && digest.value() == list.manifest_digest) return std::nullopt;
  return Error{"manifest_changed", one_line(options.manifest.string()) +
                                       ": was edited while the batch ran; put it back as it was and go on with "
                                       "--resume"};
}

std::optional<Error> fit_all(Run& run) {
  if (auto error = run.fit_recordings()) return error;
  return run.stopped() ? std::nullopt : run.fit_groups();
}

/// Whatever happened before, what is done is on the disk and run.json says how far it came.
std::optional<Error> close(const BatchOptions& options, const WorkList& list, Run& run, ResultLog& log,
                           RunRecord record) {
  if (auto error = log.sync()) return error;
  if (!run.stopped()) {
    if (auto error = check_unchanged(options, list)) return error;
    const auto digests = write_final_files(options.folder, options.manifest, list, log);
    if (!digests) return digests.error();
    record.digests = digests.value();
    if (options.report && options.shard.count == 1) {
      if (auto error = write_index(*options.report, options.manifest, list, log)) return error;
    }
  }
  record.progress = run.progress();
  record.finished = !run.stopped();
  if (auto error = write_record(options.folder, record)) return error;
  if (record.finished) remove_journal(options.folder);
  return std::nullopt;
}

}  // namespace

Result<BatchOutcome> run_batch(const BatchOptions& options, const BatchHooks& hooks) {
  const auto list = list_work(options);
  if (!list) return list.error();
  const auto lock = FolderLock::take(options.folder);
  if (!lock) return lock.error();
  if (options.report) {
    if (auto error = prepare_pages(*options.report, list.value())) return *error;
  }
  const RunRecord record = begin_record(options, list.value().manifest_digest, list.value().rows);
  auto opened = open_log(options, hooks, list.value(), record);
  if (!opened) return opened.error();
  const std::unique_ptr<ResultLog> log = std::move(opened).value();
  tell_ignored_columns(options, hooks);
  std::error_code ignored;
  std::filesystem::remove(options.folder / "summary.csv", ignored);  // of an earlier run: it comes back at the end

  Run run(options, hooks, list.value(), *log);
  const auto failed = fit_all(run);
  run.tell_replaced();
  if (failed) return *failed;
  if (auto error = close(options, list.value(), run, *log, record)) return *error;
  return BatchOutcome{run.stopped() ? BatchEnd::Stopped : BatchEnd::Finished, run.progress()};
}

}  // namespace slipfit
