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

/// Curves that a report draws behind the measured points.
struct Background {
  Spectrum spectrum;
  std::optional<Prediction> prediction;  ///< over speed, ascending; empty: the fit gives no model to predict from
  std::vector<LimitPoint> limit;         ///< by damping ratio, from 0.001 to just below 1
  Estimate reflection;                   ///< trough below F_k over peak above F_k, exp(-pi zeta / sqrt(1 - zeta^2))
};

/// Computes the curves; they are not part of the analysis because only reports need them (about a tenth of a fit's
/// time).
Background gather_background(const Recording& recording, const Analysis& analysis);

/// Returns the prediction of the sweep's fit around the speeds of its recordings, in ascending order. It is empty if
/// the fit gives no model to predict from, or if the recordings have different normal forces.
std::optional<Prediction> predict_around(std::span<const SweepEntry> entries, const SweepAnalysis& sweep);

}  // namespace slipfit
