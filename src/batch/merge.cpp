#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <fstream>
#include <set>
#include <system_error>
#include <utility>

#include "batch/folder.hpp"
#include "batch/result_log.hpp"
#include "batch/run_file.hpp"
#include "batch/tables.hpp"
#include "slipfit/batch/batch.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/report/fit_document.hpp"

namespace slipfit {
namespace {

using namespace batch;

namespace fs = std::filesystem;

ThrownError not_finished(const fs::path& folder) {
  return file_error("not_finished", folder,
                    "its files are not complete; finish it with slipfit batch --resume, then merge");
}

/// The three files of a shard, line by line in the order of its summary.
class ShardReader {
 public:
  explicit ShardReader(const fs::path& folder)
      : folder_(folder), summary_(folder / kSummary), results_(folder / kResults), failures_(folder / kFailures) {}

  /// Behind the lines of names. Errors: not_finished.
  void open() {
    std::string names;
    const bool are_ours = std::getline(summary_, names) && names == summary_names() && std::getline(failures_, names);
    if (!are_ours) throw not_finished(folder_);
    advance();
  }

  [[nodiscard]] bool at_end() const { return !place_; }
  [[nodiscard]] const SummaryPlace& place() const { return *place_; }

  /// Writes the current row and goes to the next one.
  void move_to(FinalFiles& files) {
    std::string line;
    if (!std::getline(place_->has_failed ? failures_ : results_, line)) throw not_finished(folder_);
    if (!place_->has_failed) check_result(line);
    place_->has_failed ? files.add_failure(line, row_) : files.add_result(line, row_);
    advance();
  }

 private:
  /// Error: bad_document.
  void check_result(const std::string& line) {
    const std::string name = fmt::format("{}:{}", (folder_ / kResults).string(), ++results_read_);
    if (auto error = check_fit_document(line, name)) throw ThrownError(*std::move(error));
  }

  void advance() {
    place_.reset();
    if (!std::getline(summary_, row_)) return;
    place_ = place_of(row_);
    if (!place_) throw not_finished(folder_);
  }

  fs::path folder_;
  std::ifstream summary_, results_, failures_;
  std::string row_;
  std::size_t results_read_ = 0;
  std::optional<SummaryPlace> place_;
};

/// Returns the record of a finished shard whose files are unchanged to the byte.
RunRecord record_of(const fs::path& folder) {
  const std::optional<RunRecord> found = read_record(folder);
  if (!found)
    throw file_error("not_a_batch", folder, "contains no run.json; expected a folder that slipfit batch wrote");
  const RunRecord& record = *found;
  if (!record.finished) throw not_finished(folder);
  const std::array<std::pair<const char*, std::string>, 3> written{
      {{kResults, record.digests.results}, {kSummary, record.digests.summary}, {kFailures, record.digests.failures}}};
  for (const auto& [name, text] : written) {
    const auto digest = digest_of_file((folder / name).string());
    if (digest && digest->text() == text) continue;
    throw file_error("not_as_written", folder / name,
                     "was damaged or changed since it was written; slipfit batch --resume with this folder makes it "
                     "again");
  }
  return record;
}

/// Names the first of them: their number is as large as run.json says.
ThrownError shards_missing(const RunRecord& common, const std::set<std::size_t>& given) {
  constexpr std::size_t kMostNamed = 20;
  std::vector<std::size_t> missing;
  for (std::size_t i = 1; i <= common.shard.count && missing.size() < kMostNamed; ++i) {
    if (!given.contains(i)) missing.push_back(i);
  }
  const bool are_more = common.shard.count - given.size() > missing.size();
  return ThrownError(
      {"shards_missing", fmt::format("shard {}{} of the batch of '{}' is missing; give the folders of all shards",
                                     fmt::join(missing, ", "), are_more ? ", ..." : "", printable(common.manifest))});
}

/// Returns the record that all shards share; each shard must be present once.
RunRecord common_record(const std::vector<fs::path>& shards) {
  RunRecord common;
  std::set<std::size_t> given;
  for (const fs::path& folder : shards) {
    RunRecord shard = record_of(folder);
    if (&folder == &shards.front()) {
      common = shard;
      common.progress.seconds = 0.0;
    }
    const std::size_t index = std::exchange(shard.shard.index, common.shard.index);
    if (const auto differs = difference(common, shard)) {
      throw file_error("shards_differ", folder,
                       fmt::format("belongs to another batch than '{}': {}; merge the shards of one batch",
                                   printable(shards.front().string()), *differs));
    }
    if (index < 1 || index > shard.shard.count || !given.insert(index).second) {
      throw file_error("shards_differ", folder,
                       fmt::format("is shard {} of {}, which does not exist or was given before; give each shard once",
                                   index, shard.shard.count));
    }
    common.progress.seconds += shard.progress.seconds;
    common.processor = processors_of(common, shard);
  }
  if (given.size() < common.shard.count) throw shards_missing(common, given);
  common.shard = {};
  return common;
}

/// Rows in the manifest's order, none left out and none twice. Counts them.
BatchProgress merge_rows(std::vector<ShardReader>& readers, std::size_t rows, FinalFiles& files) {
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
    first->move_to(files);
  }
  throw ThrownError({"shards_differ", fmt::format("row {} of the manifest is in no shard or in two: the sizes of the "
                                                  "recordings changed between the shards; run the shards again",
                                                  last_row + 1)});
}

void write_merged(const std::vector<fs::path>& shards, const fs::path& folder, RunRecord& record) {
  std::vector<ShardReader> readers;
  for (const fs::path& shard : shards) readers.emplace_back(shard).open();
  FinalFiles files(folder);
  BatchProgress progress = merge_rows(readers, record.rows, files);
  record.digests = files.finish();
  progress.seconds = record.progress.seconds;
  record.progress = progress;
}

BatchProgress merge_or_throw(const std::vector<fs::path>& shards, const fs::path& folder) {
  RunRecord record = common_record(shards);
  for (const fs::path& shard : shards) {
    std::error_code ignored;
    if (!fs::equivalent(shard, folder, ignored)) continue;
    throw file_error("folder_of_another_batch", folder, "is one of the shards; choose another folder with --out");
  }
  const FolderLock lock = FolderLock::take(folder);
  check_folder(folder, record);
  record.finished = false;
  write_record(folder, record);
  write_merged(shards, folder, record);
  record.finished = true;
  write_record(folder, record);
  remove_journal(folder);
  return record.progress;
}

}  // namespace

Result<BatchProgress> merge_batches(const std::vector<fs::path>& shards, const fs::path& folder) {
  return result_of([&] { return merge_or_throw(shards, folder); });
}

}  // namespace slipfit
