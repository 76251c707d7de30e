#pragma once

// The periodic motion of the Coulomb model as a sensor samples it, for tests and benchmarks.

#include <cstddef>
#include <optional>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/model/motion.hpp"
#include "support/sensitivity.hpp"

namespace slipfit {

/// Even samples of the periodic motion. Time 0 is the onset of a slip.
struct SampleTimes {
  double begin_s = 0.0;  ///< >= 0
  double step_s = 0.0;   ///< > 0
  std::size_t count = 0;
};

/// Force that the sensor sees, N. Empty where there is no stick-slip at this speed.
std::optional<std::vector<double>> damped_waveform(const Slider& slider, const Friction& friction, double speed_m_per_s,
                                                   ForceView view, const SampleTimes& times);

struct WaveformSensitivity {
  std::vector<double> force_N;
  std::vector<double> gradient;  ///< row-major, times.count x kSensitivityParameters
};

/// The spring view with exact derivatives at fixed times (later slips move with the period).
std::optional<WaveformSensitivity> damped_waveform_sensitivity(const Slider& slider, const Friction& friction,
                                                               double speed_m_per_s, const SampleTimes& times);

}  // namespace slipfit
