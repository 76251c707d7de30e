#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <system_error>
#include <utility>

#include "batch/final_files.hpp"
#include "batch/folder_check.hpp"
#include "batch/folder_lock.hpp"
#include "batch/result_log.hpp"
#include "batch/run_file.hpp"
#include "batch/summary.hpp"
#include "slipfit/batch/batch.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {
namespace {

using namespace batch;

namespace fs = std::filesystem;

Error not_finished(const fs::path& folder) {
  return {"not_finished", one_line(folder.string()) +
                              ": its files are not complete; finish it with slipfit batch "
                              "--resume, then merge"};
}

/// The three files of a shard, line by line in the order of its summary.
class ShardReader {
 public:
  explicit ShardReader(const fs::path& folder)
      : folder_(folder),
        summary_(folder / "summary.csv"),
        results_(folder / "results.jsonl"),
        failures_(folder / "failures.csv") {}

  /// Behind the lines of names. Errors: not_finished.
  std::optional<Error> open() {
    std::string names;
    if (!std::getline(summary_, names) || names != summary_names() || !std::getline(failures_, names)) {
      return not_finished(folder_);
    }
    return advance();
  }

  [[nodiscard]] bool at_end() const { return !place_; }
  [[nodiscard]] const SummaryPlace& place() const { return *place_; }

  /// Hands the current row on and goes to the next one.
  std::optional<Error> move_to(FinalFiles& files) {
    std::string line;
    if (!std::getline(place_->has_failed ? failures_ : results_, line)) return not_finished(folder_);
    auto error = place_->has_failed ? files.add_failure(line, row_) : files.add_result(line, row_);
    return error ? error : advance();
  }

 private:
  std::optional<Error> advance() {
    place_.reset();
    if (!std::getline(summary_, row_)) return std::nullopt;
    place_ = place_of(row_);
    return place_ ? std::nullopt : std::optional(not_finished(folder_));
  }

  fs::path folder_;
  std::ifstream summary_, results_, failures_;
  std::string row_;
  std::optional<SummaryPlace> place_;
};

/// A shard's files are those that were written, to the byte.
std::optional<Error> check_files(const fs::path& folder, const FileDigests& digests) {
  for (const auto& [name, written] :
       {std::pair("results.jsonl", digests.results), std::pair("summary.csv", digests.summary),
        std::pair("failures.csv", digests.failures)}) {
    const auto digest = digest_of_file((folder / name).string());
    if (digest && digest->text() == written) continue;
    return Error{"not_as_written",
                 fmt::format("{}: was damaged or changed since it was written; slipfit batch --resume "
                             "with this folder makes it again",
                             one_line((folder / name).string()))};
  }
  return std::nullopt;
}

Result<RunRecord> record_of(const fs::path& folder) {
  auto record = read_record(folder);
  if (!record) return record.error();
  if (!record.value()) {
    return Error{"not_a_batch", one_line(folder.string()) +
                                    ": holds no run.json; expected a folder that slipfit batch "
                                    "wrote"};
  }
  if (!record.value()->finished) return not_finished(folder);
  if (auto error = check_files(folder, record.value()->digests)) return *error;
  return *std::move(record).value();
}

/// What the shards have in common; all of them must be there, once.
Result<RunRecord> common_record(const std::vector<fs::path>& shards) {
  RunRecord common;
  std::set<std::size_t> missing;
  for (const fs::path& folder : shards) {
    const auto record = record_of(folder);
    if (!record) return record.error();
    RunRecord shard = record.value();
    if (&folder == &shards.front()) {
      common = shard;
      for (std::size_t i = 1; i <= shard.shard.count; ++i) missing.insert(i);
    }
    const std::size_t index = std::exchange(shard.shard.index, common.shard.index);
    if (const auto differs = difference(common, shard)) {
      return Error{"shards_differ",
                   fmt::format("{}: belongs to another batch than '{}': {}; merge the shards of one batch",
                               one_line(folder.string()), one_line(shards.front().string()), *differs)};
    }
    if (missing.erase(index) == 0) {
      return Error{"shards_differ", fmt::format("{}: is shard {} of {}, which was given before; give each shard once",
                                                one_line(folder.string()), index, shard.shard.count)};
    }
    if (&folder != &shards.front()) common.progress.seconds += shard.progress.seconds;
  }
  common.shard = {};
  if (missing.empty()) return common;
  return Error{"shards_missing", fmt::format("shard {} of the batch of '{}' is missing; give the folders of all shards",
                                             fmt::join(missing, ", "), one_line(common.manifest))};
}

/// Rows in the manifest's order, none left out and none twice.
Result<BatchProgress> merge_rows(std::vector<ShardReader>& readers, std::size_t rows, FinalFiles& files) {
  BatchProgress progress;
  std::size_t last_row = 0;
  for (;;) {
    ShardReader* first = nullptr;
    const auto key = [](const ShardReader& reader) { return std::pair(reader.place().row, reader.place().is_group); };
    for (ShardReader& reader : readers) {
      if (!reader.at_end() && (first == nullptr || key(reader) < key(*first))) first = &reader;
    }
    if (first == nullptr) break;
    const SummaryPlace place = first->place();
    if (place.row != last_row + (place.is_group ? 0 : 1)) break;
    last_row = place.row;
    ++progress.total;
    ++(place.has_failed ? progress.failed : progress.fitted);
    if (auto error = first->move_to(files)) return *error;
  }
  if (last_row == rows && std::all_of(readers.begin(), readers.end(), [](const auto& r) { return r.at_end(); })) {
    return progress;
  }
  return Error{"shards_differ",
               fmt::format("row {} of the manifest is in no shard, or in two: the recordings' sizes changed "
                           "between the shards; run the shards again",
                           last_row + 1)};
}

std::optional<Error> write_merged(const std::vector<fs::path>& shards, const fs::path& folder, RunRecord& record) {
  std::vector<ShardReader> readers;
  for (const fs::path& shard : shards) {
    if (auto error = readers.emplace_back(shard).open()) return error;
  }
  auto opened = FinalFiles::open(folder);
  if (!opened) return opened.error();
  FinalFiles files = std::move(opened).value();
  const auto progress = merge_rows(readers, record.rows, files);
  if (!progress) return progress.error();
  const auto digests = files.finish();
  if (!digests) return digests.error();
  const double seconds = record.progress.seconds;
  record.progress = progress.value();
  record.progress.seconds = seconds;
  record.digests = digests.value();
  return std::nullopt;
}

}  // namespace

Result<BatchProgress> merge_batches(const std::vector<fs::path>& shards, const fs::path& folder) {
  auto common = common_record(shards);
  if (!common) return common.error();
  RunRecord record = std::move(common).value();
  for (const fs::path& shard : shards) {
    std::error_code ignored;
    if (!fs::equivalent(shard, folder, ignored)) continue;
    return Error{"folder_of_another_batch", one_line(folder.string()) +
                                                ": is one of the shards; choose another folder "
                                                "with --out"};
  }
  const auto lock = FolderLock::take(folder);
  if (!lock) return lock.error();
  const auto before = check_folder(folder);
  if (!before) return before.error();
  if (auto error = check_same_batch(folder, before.value(), record)) return *error;
  record.finished = false;
  if (auto error = write_record(folder, record)) return *error;
  if (auto error = write_merged(shards, folder, record)) return *error;
  record.finished = true;
  if (auto error = write_record(folder, record)) return *error;
  remove_journal(folder);
  return record.progress;
}

}  // namespace slipfit
