#pragma once

#include <filesystem>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/io/named_recording.hpp"
#include "slipfit/io/read_options.hpp"
#include "slipfit/io/samples.hpp"

namespace slipfit {

/// Reads a recording as testers export it (docs/formats.md lists the formats). The reader sets `conditions.quantity`; a
/// column of friction coefficients is multiplied by `conditions.normal_force_N` if that is given.
/// `conditions.zero_force_N` is subtracted; "-" is standard input. Errors contain file, line and remedy in one line.
Result<Recording> read_recording(const std::filesystem::path& file, const Conditions& conditions,
                                 const ReadOptions& options = {});

/// Reads the recordings that `options.pieces` selects; for Pieces::One the one recording, without a name.
Result<std::vector<NamedRecording>> read_pieces(const std::filesystem::path& file, const Conditions& conditions,
                                                const ReadOptions& options = {});

/// Returns the recording of these samples, or its strokes or segments, as a file with these two columns would be read:
/// with the same options (except those that select columns or parts of a container) and the same errors, and
/// length_mismatch.
Result<std::vector<NamedRecording>> read_samples(Samples samples, const Conditions& conditions,
                                                 const ReadOptions& options = {});

}  // namespace slipfit
