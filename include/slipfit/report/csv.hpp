#pragma once

#include <string>

#include "slipfit/analysis.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/model/simulation.hpp"

namespace slipfit {

/// The cycles, one row each, units in the names (docs/formats.md). Unknown cells are empty.
std::string cycles_to_csv(const Recording& recording, const Analysis& analysis);

/// Every sample with the fitted force and the residual beside it; both empty where the fit does not reach.
std::string curve_to_csv(const Recording& recording, const Analysis& analysis);

/// A recording that slipfit reads back bit for bit: `# comment`, then time_s,force_N.
std::string trace_to_csv(const SimulatedTrace& trace, const std::string& comment);

}  // namespace slipfit
