#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit {

/// The power spectrum of the detrended, Hann-windowed force on a uniform clock (resampled if the recording's own clock
/// is uneven).
struct Spectrum {
  double bin_Hz = 0.0;        ///< frequency of bin i is i * bin_Hz
  std::vector<double> power;  ///< one-sided, (unit of force)^2 a bin; bin 0 is the mean, removed
};

/// Computes the spectrum. `held` marks samples to interpolate linearly (`Quality::impulse_mask`); empty for none.
Spectrum compute_spectrum(const Recording& recording, const std::vector<bool>& held = {});

/// A line of the spectrum that may not be stick-slip: mains, or a harmonic of it.
struct SuspiciousLine {
  double frequency_Hz = 0.0;
  std::string reason;  ///< "mains 50 Hz", "3rd harmonic of 50 Hz mains", ...
  /// The peak-to-peak amplitude of a sine with the power of the line (including the background below it), in the unit
  /// of the force.
  double swing = 0.0;
};

/// The repetition frequency that the spectrum shows.
struct SpectralFrequency {
  std::optional<double> value_Hz;  ///< empty if no comb is significant (probability above 0.01)
  /// The standard error of the mean frequency, including scatter of the periods. In simulations with scattering periods
  /// 1.96 times it covers 89-96 % from 40 cycles on, 78-95 % at 8 to 15 cycles, and less below (4 periods do not
  /// determine their scatter).
  std::optional<double> standard_error_Hz;
  double false_alarm_probability = 1.0;  ///< that noise with this background shows such a comb somewhere
  std::vector<double> harmonics_Hz;      ///< measured lines of the comb, fundamental first
  std::vector<SuspiciousLine> suspicious_lines;
  /// The standard error for regular cycles if their phases show no scatter, allowing for undetected weak scatter; empty
  /// if they do, and below 8 cycles.
  std::optional<double> regular_standard_error_Hz = std::nullopt;
};

/// Determines the frequency by a harmonic comb (without octave errors), refined by the phases of the harmonics to less
/// than a bin. It needs about 3 cycles of a sawtooth, 5 of a sine; a line of the mains is reported but never chosen
/// unless `hint_Hz` is the mains frequency. `hint_Hz` is the frequency by counting slips, used to search around it and
/// to decide between octaves; it may be empty. `spectrum` belongs to the same recording. `held` as in
/// `compute_spectrum`.
SpectralFrequency find_frequency(const Recording& recording, const Spectrum& spectrum, std::optional<double> hint_Hz,
                                 const std::vector<bool>& held = {});

}  // namespace slipfit
