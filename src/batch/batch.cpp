#include "slipfit/batch/batch.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "batch/final_files.hpp"
#include "batch/folder.hpp"
#include "batch/pages.hpp"
#include "batch/result_log.hpp"
#include "batch/run.hpp"
#include "batch/run_file.hpp"
#include "batch/work_list.hpp"
#include "slipfit/io/manifest.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {
namespace {

using namespace batch;

/// Finds what the folder holds already, and writes run.json. The order is safe against a kill at any moment: run.json
/// is there before any other file, and lines that were found are in the journal before run.json says that the batch is
/// not finished.
Result<FoundResults> prepare_folder(const BatchOptions& options, const BatchHooks& hooks, const WorkList& list,
                                    const RunRecord& now) {
  const auto before = check_folder(options.folder);
  if (!before) return before.error();
  if (auto error = check_same_batch(options.folder, before.value(), now)) return *error;
  const bool continues = before.value() && !difference(*before.value(), now);
  if (continues && !options.resume && has_results(options.folder)) {
    return file_error("results_present", options.folder,
                      "holds results of this batch; go on with --resume, or choose another folder with --out");
  }
  FoundResults found =
      continues ? find_results(options.folder, *before.value(), list) : FoundResults(list.is_mine.size());
  if (found.damaged > 0 && hooks.tell) {
    hooks.tell(
        fmt::format("{} results are not in results.jsonl as they were written, and are fitted again", found.damaged));
  }
  if (!continues) {
    if (auto error = write_record(options.folder, now)) return *error;
  }
  if (auto error = write_journal(options.folder, found)) return *error;
  if (auto error = write_record(options.folder, now)) return *error;
  std::error_code ignored;
  std::filesystem::remove(options.folder / kSummary, ignored);  // of an earlier run; written again at the end
  return found;
}

void tell_ignored_columns(const BatchOptions& options, const BatchHooks& hooks) {
  const auto reader = ManifestReader::open(options.manifest);
  if (!hooks.tell || !reader || reader.value().ignored_columns().empty()) return;
  hooks.tell(fmt::format("{}: columns that are not used: {}", one_line(options.manifest.string()),
                         fmt::join(reader.value().ignored_columns(), ", ")));
}

/// Rows are told apart by their number, so that the manifest must be the same from the first reading to the last.
std::optional<Error> check_unchanged(const BatchOptions& options, const WorkList& list) {
  const auto digest = manifest_digest(options.manifest);
  if (digest && digest.value() == list.manifest_digest) return std::nullopt;
  return file_error("manifest_changed", options.manifest,
                    "was edited while the batch ran; put it back as it was and go on with --resume");
}

/// Whatever happened before, what is done is on the disk and run.json says how far it came.
std::optional<Error> close(const BatchOptions& options, const WorkList& list, const Run& run, ResultLog& log,
                           RunRecord record) {
  log.sync();
  if (auto error = log.error()) return error;
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
  auto found = prepare_folder(options, hooks, list.value(), record);
  if (!found) return found.error();
  tell_ignored_columns(options, hooks);

  ResultLog log(options.folder, std::move(found).value());
  if (auto error = log.error()) return *error;
  Run run(options, hooks, list.value(), log);
  const auto failed = run.fit_all();
  run.tell_replaced();
  if (failed) return *failed;
  if (auto error = close(options, list.value(), run, log, record)) return *error;
  return BatchOutcome{run.stopped() ? BatchEnd::Stopped : BatchEnd::Finished, run.progress()};
}

}  // namespace slipfit
