#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit {

/// One slip as the detector sees it: the force falls from the peak to the trough. Forces in the unit of the column.
struct DetectedSlip {
  std::size_t peak = 0;     ///< sample index of the turning point before the fall
  std::size_t trough = 0;   ///< sample index of the turning point after it
  double peak_force = 0.0;  ///< median of three samples there
  double trough_force = 0.0;
  double middle_s = 0.0;  ///< when the force crosses the middle of the fall
  double fall_s = 0.0;    ///< from 80 % to 20 % of the fall: not blurred by noise on the ramps

  [[nodiscard]] double drop() const { return peak_force - trough_force; }
};

/// The slips of a recording, in order of time.
struct Segmentation {
  std::vector<DetectedSlip> slips;  ///< counted slips: drop at least a quarter of the median drop
  std::size_t minor = 0;            ///< smaller ones
  double hysteresis = 0.0;          ///< swing that makes a turning point, unit of the force column
  std::vector<double> mains_Hz;     ///< lines that were taken off the force before looking
};

/// Slips by turning points with hysteresis: the level may wander, noise and quantisation below the hysteresis count for
/// nothing, isolated impulses are passed over. Fewer than one fall larger than the noise: no slips.
Segmentation find_slips(const Recording& recording, const Quality& quality);

/// Hum whose swing is below this share of a drop moves no turning point beyond the hysteresis; the fit finds it in the
/// residuals.
inline constexpr double kHarmlessHum = 0.1;

/// The same on the recording without its mains lines, where they are large enough to hide slips or to pass for them
/// (`seen`: the slips as it stands). Empty otherwise, and where nothing is left.
std::optional<Segmentation> find_slips_beneath_hum(const Recording& recording, const Quality& quality,
                                                   const Segmentation& seen);

}  // namespace slipfit
