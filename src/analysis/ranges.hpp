#pragma once

#include <optional>

#include "slipfit/analysis.hpp"
#include "slipfit/fit/sweep.hpp"

namespace slipfit {

// Every number of a result in the range of its quantity (`within`), or unknown: text, page, tables and JSON show the
// same. Before anything is derived from the numbers.
FitResult in_range(FitResult fit, const Conditions& conditions);
FrequencyReport in_range(FrequencyReport frequency);
CycleStatistics in_range(CycleStatistics cycles);
Derived in_range(Derived derived);
Transients in_range(Transients transients);
std::optional<Coefficients> in_range(std::optional<Coefficients> coefficients);
std::optional<SweepFit> in_range(std::optional<SweepFit> sweep);

}  // namespace slipfit
