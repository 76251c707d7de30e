#include "batch/work_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <system_error>
#include <unordered_map>

#include "batch/files.hpp"
#include "io/message.hpp"
#include "slipfit/core/printable.hpp"

namespace slipfit::batch {
namespace {

/// The manifest or a recording that the batch would write over, by the same name or another (a link).
void check_not_written(const std::filesystem::path& input, const std::filesystem::path& folder) {
  std::vector<std::string_view> written(kFolderFiles.begin(), kFolderFiles.end());
  written.emplace_back(kLock);
  for (const std::string_view name : written) {
    std::error_code ignored;
    if (!std::filesystem::equivalent(input, folder / name, ignored)) continue;
    throw ThrownError({"output_is_input", fmt::format("--out: '{}' is '{}' of the results, choose another folder",
                                                      printable(input.string()), name)});
  }
}

/// Comparing every recording with every written file would be six system calls a row: the name decides which ones are.
bool has_written_name(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  return name == kLock || std::ranges::find(kFolderFiles, name) != kFolderFiles.end();
}

/// Collects what the rows of a manifest say.
class WorkCollector {
 public:
  explicit WorkCollector(const BatchOptions& options) : options_(options) {}

  void add(const ManifestEntry& entry) {
    for (const std::filesystem::path& file : {entry.file, entry.surface}) {
      if (has_written_name(file)) check_not_written(file, options_.folder);
    }
    const Digest id = digest_of(entry.id);
    if (!list_.slots.emplace(id, entry.row - 1).second) repeated_.insert(id);
    list_.rows = entry.row;
    const std::size_t first_row = options_.fit_group && !entry.group.empty() ? add_member(entry) : entry.row;
    list_.is_mine.push_back(first_row < entry.row ? list_.is_mine[first_row - 1] : next_is_mine());
  }

  WorkList finish() {
    std::vector<Group>& groups = list_.groups;
    std::ranges::sort(groups, [](const Group& a, const Group& b) { return a.last_row < b.last_row; });
    for (std::size_t g = 0; g < groups.size(); ++g) {
      list_.slots.emplace(digest_of(id_of_group(groups[g].name)), list_.slot_of_group(g));
      list_.is_mine.push_back(list_.is_mine[groups[g].first_row - 1]);
    }
    return std::move(list_);
  }

  /// Digests of the ids that occur more than once.
  [[nodiscard]] const std::set<Digest>& repeated() const { return repeated_; }

 private:
  /// Returns the first row of the entry's group.
  std::size_t add_member(const ManifestEntry& entry) {
    const auto [place, is_new] = group_of_name_.try_emplace(entry.group, list_.groups.size());
    if (is_new) list_.groups.push_back({entry.group, entry.row, entry.row});
    Group& group = list_.groups[place->second];
    group.last_row = entry.row;
    return group.first_row;
  }

  /// The shards take rows and groups in turn: whatever the files hold, a row stays on its shard, and no file but those
  /// of a shard is looked at.
  bool next_is_mine() { return pieces_++ % options_.shard.count + 1 == options_.shard.index; }

  const BatchOptions& options_;
  WorkList list_;
  std::set<Digest> repeated_;
  std::unordered_map<std::string, std::size_t> group_of_name_;
  std::size_t pieces_ = 0;  ///< rows without a group, and groups, so far
};

/// Reads the manifest once more, to list the ids that occur twice.
void check_duplicates(const std::filesystem::path& manifest, const std::set<Digest>& suspects) {
  if (suspects.empty()) return;
  std::unordered_map<std::string, std::size_t> lines;
  Entries entries(manifest);
  while (const auto entry = entries.next()) {
    if (!suspects.contains(digest_of(entry->id))) continue;
    const auto [first, is_new] = lines.try_emplace(entry->id, entry->line);
    if (!is_new) throw reading::duplicate_id(printable(manifest.string()), *entry, first->second);
  }
}

}  // namespace

std::string id_of_group(const std::string& name) {
  return "group:" + name;
}

Result<Digest> manifest_digest(const std::filesystem::path& manifest) {
  if (const auto digest = digest_of_file(manifest.string())) return *digest;
  return file_error("not_readable", manifest,
                    "is not a regular file or cannot be read; a batch reads its manifest several times")
      .error();
}

WorkList list_work(const BatchOptions& options) {
  const auto digest = manifest_digest(options.manifest);
  std::error_code ignored;
  const bool would_block = !digest && std::filesystem::is_fifo(options.manifest, ignored);
  if (would_block) throw ThrownError(digest.error());
  check_not_written(options.manifest, options.folder);
  WorkCollector collector(options);
  Entries entries(options.manifest);
  while (const auto entry = entries.next()) collector.add(*entry);
  WorkList list = collector.finish();
  list.ignored_columns = entries.ignored_columns();
  if (list.rows == 0) throw reading::empty_manifest(printable(options.manifest.string()));
  check_duplicates(options.manifest, collector.repeated());
  list.manifest_digest = value_or_throw(digest);
  return list;
}

}  // namespace slipfit::batch
