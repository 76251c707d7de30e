#pragma once

#include <optional>
#include <string>

namespace slipfit::reading {

/// The properties of a recording that its file name contains.
struct FileNameParts {
  std::optional<double> speed_m_per_s;   ///< "50mm_min", "100mmps", "10mm-s", "60mm_per_min"
  std::optional<double> normal_force_N;  ///< "3N", "232g"
  std::string group;                     ///< the name without its speed, and without a last number (a repeat)
};

/// Reads a file name without folder and extension.
FileNameParts read_file_name(const std::string& stem);

}  // namespace slipfit::reading
