#pragma once

#include <filesystem>
#include <optional>

#include "slipfit/analysis.hpp"
#include "slipfit/io/file_info.hpp"

namespace slipfit {

/// The contents of a file, and the sliding part of what would be read.
struct Inspection {
  FileInfo info;
  std::optional<TimeSpan> sliding;  ///< empty where nothing would be read
};

/// Inspects a file and detects the sliding part. Errors: those of `inspect_recording`.
Result<Inspection> inspect(const std::filesystem::path& file, const ReadOptions& options = {});

}  // namespace slipfit
