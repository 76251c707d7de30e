#pragma once

#include <filesystem>
#include <vector>

#include "io/container/kept_file.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/io/named_recording.hpp"
#include "slipfit/io/read_options.hpp"

namespace slipfit::reading {

/// As slipfit::read_pieces, of rows one after the other that name tables of one file: that is opened once.
Result<std::vector<NamedRecording>> read_pieces(KeptFile& kept, const std::filesystem::path& file,
                                                const Conditions& conditions, const ReadOptions& options);

/// As slipfit::read_recording.
Result<Recording> read_recording(KeptFile& kept, const std::filesystem::path& file, const Conditions& conditions,
                                 const ReadOptions& options);

}  // namespace slipfit::reading
