#pragma once

#include "analysis/classify.hpp"
#include "analysis/estimate.hpp"
#include "slipfit/analysis.hpp"

namespace slipfit {

/// Both frequencies and the one to quote, which is of slips (or of an oscillation that is the motion): the cycles of a
/// fit that is the model's (fitted_frequency.hpp), or harmonic least squares where they are regular and it is the
/// sharper; without such a fit the count, or harmonic least squares where they agree on regular slips. Steady sliding
/// and what cannot be told quote none, nor does what dies out where spectrum and count differ. `fit`: empty unless its
/// cycles are the model's.
FrequencyReport quote_frequency(const Recording& recording, const Signals& signals,
                                const Classification& classification, const FitResult* fit);

}  // namespace slipfit
