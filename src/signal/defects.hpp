#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "slipfit/core/recording.hpp"

namespace slipfit::signal {

/// Flags samples, alone or in pairs, that differ from both sides while the sides agree with each other (so that no
/// peak, trough or fall of a slip is flagged, however few samples it has). Empty: none.
std::vector<bool> find_impulses(std::span<const double> force, double noise_rms);

/// Step of the lattice on which all values lie, where there is one and fewer than 5 % of the values are distinct.
std::optional<double> lattice_step(std::span<const double> values);

/// Levels at which the values pile up at the ends of their range.
struct Clipping {
  std::optional<double> high;
  std::optional<double> low;
  std::size_t samples = 0;
};

Clipping find_clipping(std::span<const double> values, std::optional<double> step);

/// Returns the first sample of each run of equal values if a logger reads its converter more often than that has a new
/// value: from run to run the value changes by several steps. Empty if values repeat by rounding, or hardly at all.
std::vector<std::size_t> first_of_repeats(std::span<const double> force);

/// Returns true if the clock has a gap between these two samples: samples are missing, or a stroke ends.
bool has_gap(const Recording& recording, std::size_t first, std::size_t last);

}  // namespace slipfit::signal
