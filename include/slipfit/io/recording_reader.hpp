#pragma once

#include <filesystem>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/io/named_recording.hpp"
#include "slipfit/io/read_options.hpp"
#include "slipfit/io/samples.hpp"

namespace slipfit {

/// Reads a recording as testers export it (docs/formats.md lists what is understood). `conditions.quantity` is set by
/// the reader: a friction-coefficient column times `conditions.normal_force_N` where that is given.
/// `conditions.zero_force_N` is subtracted; "-" is standard input. Errors carry file, line and remedy in one line.
Result<Recording> read_recording(const std::filesystem::path& file, const Conditions& conditions,
                                 const ReadOptions& options = {});

/// What `options.pieces` asks for; for Pieces::One the one recording, without a name.
Result<std::vector<NamedRecording>> read_pieces(const std::filesystem::path& file, const Conditions& conditions,
                                                const ReadOptions& options = {});

/// The recording of these samples, or its strokes or segments, as a file with these two columns would be read: the same
/// options (but for those that choose columns, or what in a container), the same errors, length_mismatch.
Result<std::vector<NamedRecording>> read_samples(Samples samples, const Conditions& conditions,
                                                 const ReadOptions& options = {});

}  // namespace slipfit
