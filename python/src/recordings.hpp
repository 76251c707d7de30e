#pragma once

#include <memory>
#include <string>
#include <vector>

#include "convert.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/io/manifest_entry.hpp"

namespace slipfit::python {

/// What the cells say, with the worn track that they name.
Result<ManifestEntry> entry_of(const Cells& cells);

using SharedRecording = std::shared_ptr<Recording>;

}  // namespace slipfit::python
