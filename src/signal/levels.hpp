#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace slipfit::signal {

/// Step of the lattice on which all values lie, where there is one and fewer than 5 % of the values are distinct.
std::optional<double> lattice_step(std::span<const double> values);

/// Levels at which the values pile up at the ends of their range.
struct Clipping {
  std::optional<double> high;
  std::optional<double> low;
  std::size_t samples = 0;
};

Clipping find_clipping(std::span<const double> values, std::optional<double> step);

}  // namespace slipfit::signal
