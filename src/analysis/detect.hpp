#pragma once

#include <cstddef>
#include <optional>

#include "slipfit/core/recording.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"
#include "slipfit/signal/spectrum.hpp"

namespace slipfit {

/// What a recording shows before any model: quality, slips and the repetition frequency.
struct Signals {
  Quality quality;
  Segmentation segmentation;
  SpectralFrequency spectral;
};

/// The stretch of a recording that slides, with its quality and slips: the whole, where the user chose what to read.
/// Refers to the recording that it was made of.
struct Detected {
  const Recording* whole = nullptr;
  std::optional<Recording> part;  ///< empty: the whole recording slides
  std::size_t begin = 0;          ///< first sample of the part
  Quality whole_quality;
  Signals signals;       ///< of the part; no spectrum yet
  double seconds = 0.0;  ///< that the detection took

  [[nodiscard]] const Recording& recording() const { return part ? *part : *whole; }
};

Detected detect(const Recording& recording);

}  // namespace slipfit
