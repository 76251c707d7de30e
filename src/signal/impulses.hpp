#pragma once

#include <span>
#include <vector>

namespace slipfit::signal {

/// Flags samples, alone or in pairs, that stand out from both sides while the sides agree with each other (so that no
/// peak, trough or fall of a slip is flagged, however few samples it has). Empty: none.
std::vector<bool> find_impulses(std::span<const double> force, double noise_rms);

}  // namespace slipfit::signal
