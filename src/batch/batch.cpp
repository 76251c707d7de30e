#include "slipfit/batch/batch.hpp"

#include <fmt/format.h>

#include <memory>
#include <system_error>
#include <utility>

#include "batch/final_files.hpp"
#include "batch/folder_lock.hpp"
#include "batch/ledger.hpp"
#include "batch/pages.hpp"
#include "batch/run.hpp"
#include "batch/run_file.hpp"
#include "batch/work_list.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {
namespace {

using namespace batch;

/// Whether the folder's results may be gone on with. A folder without any is begun afresh, whosever it was.
std::optional<Error> check_resume(const BatchOptions& options, const std::optional<RunRecord>& before,
                                  const RunRecord& now) {
  const std::string folder = one_line(options.folder.string());
  if (!before) {
    return Error{"folder_of_another_batch",
                 folder + ": holds a results.jsonl without the run.json of its batch; choose another folder"};
  }
  const auto differs = difference(*before, now);
  if (differs) {
    return Error{"folder_of_another_batch",
                 fmt::format("{}: belongs to another batch: {}; put that back and use --resume, or choose another "
                             "folder with --out",
                             folder, *differs)};
  }
  if (options.resume) return std::nullopt;
  return Error{"results_present", folder +
                                      ": holds results of this batch; go on with --resume, or choose another "
                                      "folder with --out"};
}

Result<std::unique_ptr<Ledger>> open_ledger(const BatchOptions& options, const WorkList& list, const RunRecord& now) {
  const std::size_t slots = list.is_mine.size();
  if (!has_results(options.folder)) return Ledger::begin(options.folder, slots);
  const auto before = read_record(options.folder);
  if (!before) return before.error();
  if (auto error = check_resume(options, before.value(), now)) return *error;
  return Ledger::go_on(options.folder, slots, list.slots);
}

void tell_ignored_columns(const BatchOptions& options, const BatchHooks& hooks) {
  const auto reader = ManifestReader::open(options.manifest);
  if (!hooks.tell || !reader || reader.value().ignored_columns().empty()) return;
  hooks.tell(fmt::format("{}: columns that are not used: {}", one_line(options.manifest.string()),
                         fmt::join(reader.value().ignored_columns(), ", ")));
}

/// Rows are told apart by their number, so that the manifest must be the same from the first look to the last.
std::optional<Error> check_unchanged(const BatchOptions& options, const WorkList& list) {
  const auto digest = file_digest(options.manifest);
  if (!digest) return digest.error();
  if (digest.value() == list.manifest_digest) return std::nullopt;
  return Error{"manifest_changed", one_line(options.manifest.string()) +
                                       ": was edited while the batch ran; put it back as it was and go on with "
                                       "--resume"};
}

std::optional<Error> fit_all(Run& run) {
  if (auto error = run.fit_recordings()) return error;
  return run.stopped() ? std::nullopt : run.fit_groups();
}

/// Whatever happened before, what is done is on the disk and run.json says how far it came.
std::optional<Error> close(const BatchOptions& options, const WorkList& list, Run& run, Ledger& ledger,
                           RunRecord record) {
  if (auto error = ledger.sync()) return error;
  if (!run.stopped()) {
    if (auto error = check_unchanged(options, list)) return error;
    if (auto error = write_final_files(options.folder, options.manifest, list, ledger)) return error;
    if (options.report && options.shard.count == 1) {
      if (auto error = write_index(*options.report, options.manifest, list, ledger)) return error;
    }
  }
  record.progress = run.progress();
  record.finished = !run.stopped();
  return write_record(options.folder, record);
}

}  // namespace

Result<BatchOutcome> run_batch(const BatchOptions& options, const BatchHooks& hooks) {
  const auto list = list_work(options);
  if (!list) return list.error();
  const auto lock = FolderLock::take(options.folder);
  if (!lock) return lock.error();
  if (options.report) {
    if (auto error = prepare_pages(*options.report)) return *error;
  }
  const RunRecord record = begin_record(options, list.value().manifest_digest, list.value().rows);
  auto opened = open_ledger(options, list.value(), record);
  if (!opened) return opened.error();
  const std::unique_ptr<Ledger> ledger = std::move(opened).value();
  if (auto error = write_record(options.folder, record)) return *error;
  tell_ignored_columns(options, hooks);
  std::error_code ignored;
  std::filesystem::remove(options.folder / "summary.csv", ignored);  // of an earlier run: it comes back at the end

  Run run(options, hooks, list.value(), *ledger);
  if (auto error = fit_all(run)) return *error;
  if (auto error = close(options, list.value(), run, *ledger, record)) return *error;
  return BatchOutcome{run.stopped() ? BatchEnd::Stopped : BatchEnd::Finished, run.progress()};
}

}  // namespace slipfit
