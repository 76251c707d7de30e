#pragma once

#include <cstddef>
#include <optional>

#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"
#include "slipfit/signal/spectrum.hpp"

namespace slipfit {

/// What a recording shows before any model: quality, slips and the repetition frequency.
struct Signals {
  Quality quality;
  Segmentation segmentation;
  SpectralFrequency spectral;
  double seconds = 0.0;  ///< that all of it took
};

/// The stretch of a recording that slides, with its quality and slips: the whole, where the user chose what to read.
struct Sliding {
  std::optional<Recording> part;  ///< empty: the whole recording slides
  std::size_t begin = 0;          ///< its first sample in the recording
  Quality whole_quality;          ///< of the recording
  Signals signals;                ///< of the part; no spectrum yet

  [[nodiscard]] const Recording& of(const Recording& whole) const { return part ? *part : whole; }
};

Sliding find_sliding(const Recording& recording);

/// The spectrum's frequency, and the seconds that it took.
struct SpectrumLook {
  SpectralFrequency spectral;
  double seconds = 0.0;
};

/// Of a recording whose quality and slips are in `signals`.
SpectrumLook look_at_spectrum(const Recording& recording, const Signals& signals);

/// A line of the mains stands out and may move turning points, or the slips counted may be its swings: worth a second
/// look beneath it.
bool may_be_hum(const Signals& signals);

}  // namespace slipfit
