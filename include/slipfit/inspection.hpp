#pragma once

#include <filesystem>
#include <optional>

#include "slipfit/analysis.hpp"
#include "slipfit/io/file_info.hpp"

namespace slipfit {

/// What a file holds, and the stretch that slides in the part that would be read.
struct Inspection {
  FileInfo info;
  std::optional<TimeSpan> sliding;  ///< empty where nothing would be read
};

/// Errors: those of `inspect_recording`.
Result<Inspection> inspect(const std::filesystem::path& file, const ReadOptions& options = {});

}  // namespace slipfit
