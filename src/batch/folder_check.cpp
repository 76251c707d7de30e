#include "batch/folder_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

#include "batch/files.hpp"
#include "batch/result_log.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit::batch {
namespace {

constexpr auto kNames =
    std::to_array<std::string_view>({"results.jsonl", "summary.csv", "failures.csv", "run.json", "journal"});

}  // namespace

Result<std::optional<RunRecord>> check_folder(const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const std::string_view name : kNames) {
    if (!std::filesystem::is_symlink(folder / name, ignored)) continue;
    return Error{"cannot_write",
                 fmt::format("{}: is a symbolic link, which is not followed; remove it, or choose another "
                             "folder",
                             one_line((folder / name).string()))};
  }
  auto record = read_record(folder);
  if (!record) return record;
  for (const std::string_view name : kNames) {
    if (record.value() || !std::filesystem::exists(folder / name, ignored)) continue;
    return Error{"folder_of_another_batch",
                 fmt::format("{}: holds '{}' without the run.json of its batch; choose another folder",
                             one_line(folder.string()), name)};
  }
  remove_leftovers(folder,
                   [](std::string_view name) { return std::find(kNames.begin(), kNames.end(), name) != kNames.end(); });
  return record;
}

std::optional<Error> check_same_batch(const std::filesystem::path& folder, const std::optional<RunRecord>& before,
                                      const RunRecord& now) {
  const auto differs = before && has_results(folder) ? difference(*before, now) : std::nullopt;
  if (!differs) return std::nullopt;
  return Error{"folder_of_another_batch",
               fmt::format("{}: holds results of another batch: {}; put that back and use --resume, or choose another "
                           "folder with --out",
                           one_line(folder.string()), *differs)};
}

}  // namespace slipfit::batch
