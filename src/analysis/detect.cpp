#include "analysis/detect.hpp"

#include <utility>

#include "analysis/slip_shape.hpp"
#include "analysis/stopwatch.hpp"

namespace slipfit {

Detected detect(const Recording& recording) {
  const Stopwatch stopwatch;
  Detected detected;
  detected.whole = &recording;
  Signals& signals = detected.signals;
  signals.quality = assess_quality(recording);
  signals.segmentation = find_slips(recording, signals.quality);
  detected.whole_quality = signals.quality;
  const Segmentation& seen = signals.segmentation;
  const bool whole = seen.sliding_begin == 0 && seen.sliding_end == recording.size();
  if (!whole && !recording.provenance().window_given) {
    Recording part = recording.part(seen.sliding_begin, seen.sliding_end);
    Quality quality = assess_quality(part);
    Segmentation slips = find_slips(part, quality);
    // A ring-down is told by what comes after it, waves and noise by the whole.
    if (slips_are_sudden(slips)) {
      detected.begin = seen.sliding_begin;
      detected.part = std::move(part);
      signals.quality = std::move(quality);
      signals.segmentation = std::move(slips);
    }
  }
  detected.seconds = stopwatch.elapsed_s();
  return detected;
}

}  // namespace slipfit
