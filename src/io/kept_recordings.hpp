#pragma once

#include <filesystem>
#include <vector>

#include "io/container/kept_file.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/io/named_recording.hpp"
#include "slipfit/io/read_options.hpp"

namespace slipfit::reading {

/// Reads pieces like slipfit::read_pieces; consecutive rows that name tables of one file open it once.
Result<std::vector<NamedRecording>> read_pieces(KeptFile& kept, const std::filesystem::path& file,
                                                const Conditions& conditions, const ReadOptions& options);

/// Reads a recording like slipfit::read_recording.
Result<Recording> read_recording(KeptFile& kept, const std::filesystem::path& file, const Conditions& conditions,
                                 const ReadOptions& options);

}  // namespace slipfit::reading
