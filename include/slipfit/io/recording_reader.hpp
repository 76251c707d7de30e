#pragma once

#include <filesystem>

#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/io/read_options.hpp"

namespace slipfit {

/// Reads a recording as testers export it (docs/formats.md lists what is understood). `conditions.quantity` is set by
/// the reader: a friction-coefficient column times `conditions.normal_force_N` where that is given.
/// `conditions.zero_force_N` is subtracted. Errors carry file, line and remedy in one line.
Result<Recording> read_recording(const std::filesystem::path& file, const Conditions& conditions,
                                 const ReadOptions& options = {});

}  // namespace slipfit
