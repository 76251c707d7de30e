#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "slipfit/core/recording.hpp"

namespace slipfit {

/// The counts of defects of a recording. Nothing is corrected here: fit/ masks samples where necessary, and warnings
/// report it.
struct Quality {
  double noise_rms = 0.0;  ///< white-noise level from differences (at least that of rounding), unit of the force column
  std::optional<double> quantisation_step;  ///< set where all values lie on one lattice coarser than the noise
  std::optional<double> clip_high;          ///< level at which the sensor saturates
  std::optional<double> clip_low;
  std::size_t clipped_samples = 0;
  std::size_t impulses = 0;  ///< isolated samples far from both neighbours
  std::size_t gaps = 0;      ///< steps longer than 3.5 median steps
  double longest_gap_s = 0.0;
  double clock_jitter = 0.0;       ///< robust relative spread of the time step, gaps aside
  std::vector<bool> impulse_mask;  ///< one flag a sample; empty where there is none
};

Quality assess_quality(const Recording& recording);

}  // namespace slipfit
