#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit {

/// Power spectrum of the detrended, Hann-windowed force on a uniform clock (resampled where the recording's own is
/// uneven).
struct Spectrum {
  double bin_Hz = 0.0;        ///< frequency of bin i is i * bin_Hz
  std::vector<double> power;  ///< one-sided, (unit of force)^2 a bin; bin 0 is the mean, removed
};

/// `held`: samples to bridge by a line (`Quality::impulse_mask`); empty: none.
Spectrum compute_spectrum(const Recording& recording, const std::vector<bool>& held = {});

/// A line of the spectrum that may not be stick-slip: mains, or a harmonic of it.
struct SuspiciousLine {
  double frequency_Hz = 0.0;
  std::string reason;  ///< "mains 50 Hz", "3rd harmonic of 50 Hz mains", ...
  /// Peak to peak of a sine with the line's power (what stands beneath it counts in), unit of force.
  double swing = 0.0;
};

/// The repetition frequency that the spectrum shows.
struct SpectralFrequency {
  std::optional<double> value_Hz;  ///< empty where no comb stands out (probability above 0.01)
  /// Of the mean frequency, periods that scatter included. 1.96 of it cover, in simulation with scattering periods,
  /// 89-96 % from 40 cycles on, 78-95 % at 8 to 15 cycles, less below (4 periods do not tell their scatter).
  std::optional<double> standard_error_Hz;
  double false_alarm_probability = 1.0;  ///< that noise with this background shows such a comb somewhere
  std::vector<double> harmonics_Hz;      ///< measured lines of the comb, fundamental first
  std::vector<SuspiciousLine> suspicious_lines;
  /// `standard_error_Hz` where the phases of the cycles show no scatter, for that case (weak scatter that hides in them
  /// allowed for). Empty where they do, and below 8 cycles.
  std::optional<double> regular_standard_error_Hz = std::nullopt;
};

/// Harmonic comb (no octave error), refined below a bin by the phases of the harmonics on the trace. Needs about 3
/// cycles of a saw-tooth, 5 of a sine; a line of the mains is named, never chosen, unless `hint_Hz` is the mains
/// frequency. `hint_Hz`: the frequency by counting slips, used to search around it and to decide between octaves;
/// empty: none. `spectrum`: of the same recording. `held` as in `compute_spectrum`.
SpectralFrequency find_frequency(const Recording& recording, const Spectrum& spectrum, std::optional<double> hint_Hz,
                                 const std::vector<bool>& held = {});

}  // namespace slipfit
