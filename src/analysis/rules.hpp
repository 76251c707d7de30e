#pragma once

#include "analysis/detect.hpp"
#include "slipfit/analysis.hpp"
#include "slipfit/signal/cycles.hpp"

namespace slipfit {

/// The input of the rules for one recording.
struct Facts {
  const Detected& detected;
  const Segmentation& slips;
  const Analysis& analysis;
};

/// Returns true if a warning is a fact; false for a code without a rule.
bool is_fact(const Warning& warning);

/// The warnings of the reader, of the fit and of the rules, those with the largest effect first.
Warnings collect_warnings(const Facts& facts);

/// The warnings in the order of the rules; codes without a rule come last.
Warnings by_effect(Warnings warnings);

/// The fit with the parameters that a warning limits at most conditional.
FitResult limited_by(const Warnings& warnings, FitResult fit);

}  // namespace slipfit
