#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "slipfit/io/read_options.hpp"

namespace slipfit::reading {

/// Returns the stated options as columns of a manifest and their cells; numbers are in SI.
std::vector<std::pair<std::string, std::string>> stated_cells(const ReadOptions& options);

/// The meaning of "5 N/V": newtons for one SI unit of the column's quantity, or for one of the unit itself if the unit
/// is unknown ("0.02 N/raw").
struct ForceScale {
  double N_per_SI = 1.0;
  std::string unit;  ///< "V"
};
std::optional<ForceScale> parse_force_scale(std::string_view text);

}  // namespace slipfit::reading
