#include "batch/work_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "batch/shards.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit::batch {
namespace {

constexpr std::uint64_t kSizeOfNothing = 4096;  // opening a file costs something too, also a missing one

std::uint64_t size_of(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  return kSizeOfNothing + (error ? 0 : size);
}

/// The groups as the rows pass by.
class GroupTable {
 public:
  const Group& add(const ManifestEntry& entry) {
    const auto [place, is_new] = index_.try_emplace(entry.group, groups_.size());
    if (is_new) groups_.push_back({entry.group, entry.row, entry.row});
    Group& group = groups_[place->second];
    group.last_row = entry.row;
    return group;
  }

  std::vector<Group> by_last_row() && {
    std::sort(groups_.begin(), groups_.end(), [](const Group& a, const Group& b) { return a.last_row < b.last_row; });
    return std::move(groups_);
  }

 private:
  std::vector<Group> groups_;
  std::unordered_map<std::string, std::size_t> index_;
};

/// Which rows stay together on one shard, and how large they are.
class Pieces {
 public:
  void add(const ManifestEntry& entry, std::size_t first_row) {
    sizes_.push_back(0);
    first_rows_.push_back(static_cast<std::uint32_t>(first_row));
    sizes_[first_row - 1] += size_of(entry.file);
  }

  [[nodiscard]] std::vector<bool> rows_of(const Shard& shard) const {
    const std::vector<std::uint32_t> shard_of = spread(sizes_, shard.count);
    std::vector<bool> is_mine;
    for (const std::uint32_t first_row : first_rows_) is_mine.push_back(shard_of[first_row - 1] == shard.index);
    return is_mine;
  }

 private:
  std::vector<std::uint64_t> sizes_;  ///< of a row and of the later members of its group, whose own are 0
  std::vector<std::uint32_t> first_rows_;
};

constexpr auto kWritten =
    std::to_array<std::string_view>({"results.jsonl", "summary.csv", "failures.csv", "run.json", "journal", "lock"});

/// The manifest or a recording that the batch would write over, by the same name or another (a link).
std::optional<Error> check_not_written(const std::filesystem::path& input, const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const std::string_view name : kWritten) {
    if (!std::filesystem::equivalent(input, folder / name, ignored)) continue;
    return Error{"output_is_input", fmt::format("--out: '{}' is '{}' of the results, choose another folder",
                                                one_line(input.string()), name)};
  }
  return std::nullopt;
}

/// Six looks at the disk for each row would be too many: a recording is suspected by its name.
bool has_written_name(const ManifestEntry& entry) {
  return std::find(kWritten.begin(), kWritten.end(), entry.file.filename().string()) != kWritten.end();
}

/// Reads the manifest once more, to tell which ids stand in it twice.
std::optional<Error> find_duplicate(const std::filesystem::path& manifest, std::vector<Digest> suspects) {
  if (suspects.empty()) return std::nullopt;
  std::unordered_map<std::string, std::size_t> lines;
  return for_each_entry(manifest, [&](const ManifestEntry& entry) -> std::optional<Error> {
    if (!std::binary_search(suspects.begin(), suspects.end(), digest_of(entry.id))) return std::nullopt;
    const auto [first, is_new] = lines.try_emplace(entry.id, entry.line);
    if (is_new) return std::nullopt;
    return Error{"duplicate_id", fmt::format("{}:{}: column 'id': '{}' stands in line {} too, expected another id",
                                             one_line(manifest.string()), entry.line, entry.id, first->second)};
  });
}

}  // namespace

std::optional<Error> for_each_entry(const std::filesystem::path& manifest,
                                    const std::function<std::optional<Error>(const ManifestEntry&)>& use) {
  auto opened = ManifestReader::open(manifest);
  if (!opened) return opened.error();
  ManifestReader reader = std::move(opened).value();
  for (;;) {
    auto next = reader.next();
    if (!next) return next.error();
    if (!next.value()) return std::nullopt;
    if (auto error = use(*next.value())) return error;
  }
}

std::optional<Error> for_each_result(const std::filesystem::path& manifest, const WorkList& list,
                                     const std::function<std::optional<Error>(const ManifestEntry&)>& use_entry,
                                     const std::function<std::optional<Error>(std::size_t group)>& use_group) {
  std::size_t group = 0;
  return for_each_entry(manifest, [&](const ManifestEntry& entry) -> std::optional<Error> {
    if (auto error = use_entry(entry)) return error;
    for (; group < list.groups.size() && list.groups[group].last_row == entry.row; ++group) {
      if (auto error = use_group(group)) return error;
    }
    return std::nullopt;
  });
}

std::string id_of_group(const std::string& name) {
  return "group:" + name;
}

Result<Digest> manifest_digest(const std::filesystem::path& manifest) {
  if (const auto digest = digest_of_file(manifest.string())) return *digest;
  return Error{"not_readable", one_line(manifest.string()) +
                                   ": is no regular file, or cannot be read; a batch reads its manifest several times"};
}

Result<WorkList> list_work(const BatchOptions& options) {
  WorkList list;
  GroupTable groups;
  Pieces pieces;
  const bool is_sharded = options.shard.count > 1;
  const auto digest = manifest_digest(options.manifest);
  std::error_code ignored;
  if (!digest && std::filesystem::is_fifo(options.manifest, ignored)) return digest.error();  // reading it would block
  if (auto error = check_not_written(options.manifest, options.folder)) return *error;
  auto failed = for_each_entry(options.manifest, [&](const ManifestEntry& entry) -> std::optional<Error> {
    if (has_written_name(entry)) {
      if (auto error = check_not_written(entry.file, options.folder)) return error;
    }
    list.slots.add(entry.id, entry.row - 1);
    list.rows = entry.row;
    const bool is_member = options.fit_group && !entry.group.empty();
    const std::size_t first_row = is_member ? groups.add(entry).first_row : entry.row;
    if (is_sharded) pieces.add(entry, first_row);
    return std::nullopt;
  });
  if (failed) return *failed;
  const std::string name = one_line(options.manifest.string());
  if (list.rows == 0) return Error{"empty_manifest", name + ": holds no recordings; expected a line for each"};
  list.is_mine = is_sharded ? pieces.rows_of(options.shard) : std::vector<bool>(list.rows, true);
  list.groups = std::move(groups).by_last_row();
  for (std::size_t g = 0; g < list.groups.size(); ++g) {
    list.slots.add(id_of_group(list.groups[g].name), list.slot_of_group(g));
    list.is_mine.push_back(list.is_mine[list.groups[g].first_row - 1]);
  }
  list.slots.sort();
  if (auto error = find_duplicate(options.manifest, list.slots.repeated())) return *error;
  if (!digest) return digest.error();
  list.manifest_digest = digest.value();
  return list;
}

}  // namespace slipfit::batch
