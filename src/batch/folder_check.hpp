#pragma once

#include <filesystem>
#include <optional>

#include "batch/run_file.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit::batch {

/// The record of the batch that a folder holds, if any; what killed processes left half written is removed. Errors:
/// folder_of_another_batch where it holds files of a batch's names that no batch wrote, cannot_write where they are
/// symbolic links, which are not followed.
Result<std::optional<RunRecord>> check_folder(const std::filesystem::path& folder);

/// Error: folder_of_another_batch where the folder holds results of another batch than `now`.
std::optional<Error> check_same_batch(const std::filesystem::path& folder, const std::optional<RunRecord>& before,
                                      const RunRecord& now);

}  // namespace slipfit::batch
