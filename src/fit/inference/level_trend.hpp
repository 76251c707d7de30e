#pragma once

#include <span>

#include "fit/inference/intervals.hpp"
#include "fit/selection/solution.hpp"
#include "fit/sweep/sweep_data.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/result.hpp"

namespace slipfit::fit {

/// The trend of a force level and what it means for k and for absolute forces. The slope of a stick is k V plus the
/// drift of the sensor; a change of the friction is not in it. docs/model.md section 14
struct TrendFindings {
  LevelTrend trend{};
  bool is_significant = false;  ///< above thresholds::kSureSigmas standard errors
  bool is_per_cycle = false;    ///< every cycle has its own level: k of the fit is that of friction that changes
  bool mass_is_stated = false;  ///< and gives w_n, which is proportional to the root of k
  double log_k_to_value = 0.0;  ///< from ln k of the fit to that of the reading to report
  double log_k_to_other = 0.0;  ///< from there to the other possible reading; 0 where the reading is known
};

TrendFindings find_level_trend(const Recording& recording, const DampedFit& fit);

/// Returns the trend of the recordings of a sweep, weighted as they determine k: the mean change of ln k by the
/// readings, and the widest range of a level. Rates differ between the recordings, so the result has no rate.
TrendFindings trend_of_sweep(std::span<const SweepRecording> recordings, const SweepData& data, const Held& held);

/// The values by the reading to report.
Coordinates with_trend(const Coordinates& values, const TrendFindings& trend);

/// The spread with the other reading of the trend and, of absolute forces, the range of the level.
Spread with_trend(Spread spread, const TrendFindings& trend, double force_unit);

}  // namespace slipfit::fit
