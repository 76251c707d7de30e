#pragma once

#include <optional>
#include <span>
#include <vector>

#include "slipfit/analysis.hpp"
#include "slipfit/predict/prediction.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit {

/// A point of the limit of stick-slip from rest, docs/model.md (6).
struct LimitPoint {
  double damping_ratio = 0.0;
  double lambda = 0.0;
};

/// What a report draws behind the measured points.
struct Background {
  Spectrum spectrum;
  std::optional<Prediction> prediction;  ///< over speed, ascending; empty: the fit gives no model to predict from
  std::vector<LimitPoint> limit;         ///< by damping ratio, from 0.001 to just below 1
  Estimate reflection;                   ///< trough below F_k over peak above F_k, exp(-pi zeta / sqrt(1 - zeta^2))
};

/// Beside the analysis, not in it: only reports need it (about a tenth of a fit's time).
Background gather_background(const Recording& recording, const Analysis& analysis);

/// What the fit of the sweep predicts around the speeds of its recordings, ascending. Empty where it gives no model to
/// predict from, or where the recordings have different normal forces.
std::optional<Prediction> predict_around(std::span<const SweepEntry> entries, const SweepAnalysis& sweep);

}  // namespace slipfit
