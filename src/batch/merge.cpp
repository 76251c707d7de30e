#include <fmt/format.h>

#include <array>
#include <fstream>
#include <set>
#include <system_error>
#include <utility>

#include "batch/final_files.hpp"
#include "batch/folder.hpp"
#include "batch/result_log.hpp"
#include "batch/run_file.hpp"
#include "batch/tables.hpp"
#include "slipfit/batch/batch.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {
namespace {

using namespace batch;

namespace fs = std::filesystem;

Error not_finished(const fs::path& folder) {
  return file_error("not_finished", folder,
                    "its files are not complete; finish it with slipfit batch --resume, then merge");
}

/// The three files of a shard, line by line in the order of its summary.
class ShardReader {
 public:
  explicit ShardReader(const fs::path& folder)
      : folder_(folder), summary_(folder / kSummary), results_(folder / kResults), failures_(folder / kFailures) {}

  /// Behind the lines of names. Errors: not_finished.
  std::optional<Error> open() {
    std::string names;
    const bool are_ours = std::getline(summary_, names) && names == summary_names() && std::getline(failures_, names);
    return are_ours ? advance() : not_finished(folder_);
  }

  [[nodiscard]] bool at_end() const { return !place_; }
  [[nodiscard]] const SummaryPlace& place() const { return *place_; }

  /// Writes the current row and goes to the next one.
  std::optional<Error> move_to(FinalFiles& files) {
    std::string line;
    if (!std::getline(place_->has_failed ? failures_ : results_, line)) return not_finished(folder_);
    place_->has_failed ? files.add_failure(line, row_) : files.add_result(line, row_);
    return advance();
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

/// Of a shard that is finished and whose files are as they were written, to the byte.
Result<RunRecord> record_of(const fs::path& folder) {
  const auto found = read_record(folder);
  if (!found) return found.error();
  if (!found.value()) {
    return file_error("not_a_batch", folder, "holds no run.json; expected a folder that slipfit batch wrote");
  }
  const RunRecord& record = *found.value();
  if (!record.finished) return not_finished(folder);
  const std::array<std::pair<const char*, std::string>, 3> written{
      {{kResults, record.digests.results}, {kSummary, record.digests.summary}, {kFailures, record.digests.failures}}};
  for (const auto& [name, text] : written) {
    const auto digest = digest_of_file((folder / name).string());
    if (digest && digest->text() == text) continue;
    return file_error("not_as_written", folder / name,
                      "was damaged or changed since it was written; slipfit batch --resume with this folder makes it "
                      "again");
  }
  return record;
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
      common.progress.seconds = 0.0;
      for (std::size_t i = 1; i <= shard.shard.count; ++i) missing.insert(i);
    }
    const std::size_t index = std::exchange(shard.shard.index, common.shard.index);
    if (const auto differs = difference(common, shard)) {
      return file_error("shards_differ", folder,
                        fmt::format("belongs to another batch than '{}': {}; merge the shards of one batch",
                                    one_line(shards.front().string()), *differs));
    }
    if (missing.erase(index) == 0) {
      return file_error(
          "shards_differ", folder,
          fmt::format("is shard {} of {}, which was given before; give each shard once", index, shard.shard.count));
    }
    common.progress.seconds += shard.progress.seconds;
  }
  common.shard = {};
  if (missing.empty()) return common;
  return Error{"shards_missing", fmt::format("shard {} of the batch of '{}' is missing; give the folders of all shards",
                                             fmt::join(missing, ", "), one_line(common.manifest))};
}

/// Rows in the manifest's order, none left out and none twice. Counts them.
Result<BatchProgress> merge_rows(std::vector<ShardReader>& readers, std::size_t rows, FinalFiles& files) {
  BatchProgress progress;
  std::size_t last_row = 0;
  for (;;) {
    ShardReader* first = nullptr;
    const auto key = [](const ShardReader& reader) { return std::pair(reader.place().row, reader.place().is_group); };
    for (ShardReader& reader : readers) {
      if (!reader.at_end() && (first == nullptr || key(reader) < key(*first))) first = &reader;
    }
    if (first == nullptr && last_row == rows) return progress;
    if (first == nullptr || first->place().row != last_row + (first->place().is_group ? 0 : 1)) break;
    last_row = first->place().row;
    ++progress.total;
    ++(first->place().has_failed ? progress.failed : progress.fitted);
    if (auto error = first->move_to(files)) return *error;
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
  FinalFiles files(folder);
  const auto progress = merge_rows(readers, record.rows, files);
  if (!progress) return progress.error();
  const auto digests = files.finish();
  if (!digests) return digests.error();
  record.digests = digests.value();
  const double seconds = std::exchange(record.progress, progress.value()).seconds;
  record.progress.seconds = seconds;
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
    return file_error("folder_of_another_batch", folder, "is one of the shards; choose another folder with --out");
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
