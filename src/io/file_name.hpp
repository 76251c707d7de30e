#pragma once

#include <optional>
#include <string>

namespace slipfit::reading {

/// What people write into the names of recordings.
struct ToldByName {
  std::optional<double> speed_m_per_s;   ///< "50mm_min", "100mmps", "10mm-s", "60mm_per_min"
  std::optional<double> normal_force_N;  ///< "3N", "232g"
  std::string group;                     ///< the name without its speed, and without a last number (a repeat)
};

/// Of a name without folder and ending.
ToldByName read_file_name(const std::string& stem);

}  // namespace slipfit::reading
