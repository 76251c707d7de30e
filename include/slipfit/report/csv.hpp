#pragma once

#include <string>

#include "slipfit/analysis.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/model/simulation.hpp"

namespace slipfit {

/// Writes the cycles, one row each, with units in the names (docs/formats.md). Unknown cells are empty.
std::string cycles_to_csv(const Recording& recording, const Analysis& analysis);

/// Writes every sample with the fitted force and the residual; both are empty outside the fitted part.
std::string curve_to_csv(const Recording& recording, const Analysis& analysis);

/// Writes a recording that slipfit reads back bit for bit: `# comment`, then time_s,force_N.
std::string trace_to_csv(const SimulatedTrace& trace, const std::string& comment);

}  // namespace slipfit
