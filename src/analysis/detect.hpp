#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"
#include "slipfit/signal/spectrum.hpp"

namespace slipfit {

/// Properties of a recording that need no model: quality, slips and repetition frequency.
struct Signals {
  Quality quality;
  Segmentation segmentation;
  SpectralFrequency spectral;
};

/// The stretch of a recording that slides, with its quality and slips: the whole, where the user chose what to read. Of
/// values that a logger read more than once each is taken once. Refers to the recording that it was made of.
struct Detected {
  const Recording* whole = nullptr;
  std::optional<Recording> part;  ///< empty: the whole recording slides
  std::size_t begin = 0;          ///< first sample of the part
  std::vector<std::size_t> kept;  ///< samples of the recording that the part counts; empty: all of them
  Quality whole_quality;
  Signals signals;       ///< of the part; no spectrum yet
  double seconds = 0.0;  ///< that the detection took

  [[nodiscard]] const Recording& recording() const { return part ? *part : *whole; }
  /// The recording's sample that is number i of the part.
  [[nodiscard]] std::size_t sample_of(std::size_t i) const { return kept.empty() ? begin + i : kept[begin + i]; }
  /// Returns the number of samples of the recording that are averaged in one sample of the part; 1 if none are
  /// repeated.
  [[nodiscard]] double repeats() const {
    return kept.empty() ? 1.0 : static_cast<double>(whole->size()) / static_cast<double>(kept.size());
  }
};

Detected detect(const Recording& recording);

/// Wall-clock seconds since it was made.
class Stopwatch {
 public:
  [[nodiscard]] double elapsed_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace slipfit
