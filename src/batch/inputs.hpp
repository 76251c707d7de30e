#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace slipfit::batch {

enum class InputState { Same, Changed, Gone };

/// Whether the files of a recording, or of a group's recordings, are those that a document was made of, by their sizes
/// and digests. Gone: one cannot be read, and none is known to be another.
InputState compare_inputs(const std::string& document, const std::vector<std::filesystem::path>& inputs);

}  // namespace slipfit::batch
