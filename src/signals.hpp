#pragma once

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

/// All but the spectrum.
Signals look_at_slips(const Recording& recording);

/// The spectrum's frequency, and the seconds that it took.
struct SpectrumLook {
  SpectralFrequency spectral;
  double seconds = 0.0;
};
SpectrumLook look_at_spectrum(const Recording& recording, const Quality& quality, const Segmentation& segmentation);
void add_spectrum(Signals& signals, SpectrumLook look);

Signals look_at(const Recording& recording);

/// A line of the mains stands out and may move turning points, or the slips counted may be its swings: worth a second
/// look beneath it.
bool may_be_hum(const Signals& signals);

}  // namespace slipfit
