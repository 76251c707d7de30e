#pragma once

#include <future>

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

/// The spectrum's frequency, and the seconds that it took.
struct SpectrumLook {
  SpectralFrequency spectral;
  double seconds = 0.0;
};

/// From the quality in `signals`, and from the slips in it as soon as these are found: the spectrum itself does without
/// them and may be computed meanwhile, in another thread.
SpectrumLook look_at_spectrum(const Recording& recording, const Signals& signals,
                              const std::shared_future<void>& slips_found);
/// Of slips that are found.
SpectrumLook look_at_spectrum(const Recording& recording, const Signals& signals);

Signals look_at(const Recording& recording);

/// A line of the mains stands out and may move turning points, or the slips counted may be its swings: worth a second
/// look beneath it.
bool may_be_hum(const Signals& signals);

}  // namespace slipfit
