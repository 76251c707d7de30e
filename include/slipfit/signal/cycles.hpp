#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit {

/// A slip as detected: the force falls from the peak to the trough. Forces are in the unit of the column.
struct DetectedSlip {
  std::size_t peak = 0;     ///< sample index of the turning point before the fall
  std::size_t trough = 0;   ///< sample index of the turning point after it
  double peak_force = 0.0;  ///< median of three samples there
  double trough_force = 0.0;
  double middle_s = 0.0;  ///< when the force crosses the middle of the fall
  double fall_s = 0.0;    ///< from 80 % to 20 % of the fall: not blurred by noise on the ramps
  double rise_s = 0.0;    ///< from 20 % to 80 % of the rise to the next slip; 0 after the last

  [[nodiscard]] double drop() const { return peak_force - trough_force; }
};

/// The slips of a recording, in order of time.
struct Segmentation {
  std::vector<DetectedSlip> slips;  ///< counted slips: drop at least a quarter of the median drop
  std::size_t minor = 0;            ///< smaller ones
  double hysteresis = 0.0;          ///< swing that makes a turning point, unit of the force column
  double noise = 0.0;               ///< standard deviation at the time scale of the slips, unit of the force column
  std::size_t smoothed_over = 1;    ///< samples; more than one where ringing or noise would hide the slips
  std::size_t sliding_begin = 0;    ///< the slips follow each other from this sample
  std::size_t sliding_end = 0;      ///< to the one before this
  std::vector<double> mains_Hz;     ///< lines that were taken off the force before looking
};

/// Detects slips, which are sudden falls after slow rises, at their own time scale: the level may wander, noise and
/// quantisation below the hysteresis are ignored, isolated impulses are skipped, and ringing after a slip belongs to
/// it. Waves have falls, too, as slow as their rises. There are no slips without a fall larger than the noise. `scale`
/// is the number of samples smoothed over in a recording with the same slips; without it all scales are tried.
Segmentation find_slips(const Recording& recording, const Quality& quality,
                        std::optional<std::size_t> scale = std::nullopt);

/// Hum whose amplitude is below this share of a drop moves no turning point beyond the hysteresis; the fit finds it in
/// the residuals.
inline constexpr double kHarmlessHum = 0.1;

/// Detects slips in the recording without its mains lines, if they are large enough to conceal slips or to resemble
/// them (`seen`: the slips without subtraction). The result is empty otherwise, and if no slips remain.
std::optional<Segmentation> find_slips_beneath_hum(const Recording& recording, const Quality& quality,
                                                   const Segmentation& seen);

}  // namespace slipfit
