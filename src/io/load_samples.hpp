#pragma once

#include "io/opened_file.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/io/samples.hpp"

namespace slipfit::reading {

/// The samples as a file of two columns whose rows are read. Errors: length_mismatch, unknown_unit, no_time_column,
/// conflicting_options, those of check_options.
Result<LoadedFile> load_samples(Samples samples, const ReadOptions& options);

}  // namespace slipfit::reading
