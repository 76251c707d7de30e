#include "analysis/detect.hpp"

#include <utility>

#include "analysis/slip_shape.hpp"
#include "analysis/stopwatch.hpp"
#include "signal/repeats.hpp"

namespace slipfit {

Detected detect(const Recording& recording) {
  const Stopwatch stopwatch;
  Detected detected;
  detected.whole = &recording;
  detected.kept = signal::first_of_repeats(recording.force());
  if (!detected.kept.empty()) detected.part = recording.selected(detected.kept);
  Signals& signals = detected.signals;
  signals.quality = assess_quality(detected.recording());
  signals.segmentation = find_slips(detected.recording(), signals.quality);
  detected.whole_quality = signals.quality;
  const std::size_t begin = signals.segmentation.sliding_begin;
  const std::size_t end = signals.segmentation.sliding_end;
  const bool whole = begin == 0 && end == detected.recording().size();
  if (!whole && !recording.provenance().window_given) {
    Recording part = detected.recording().part(begin, end);
    Quality quality = assess_quality(part);
    Segmentation slips = find_slips(part, quality);
    // A ring-down is told by what comes after it, waves and noise by the whole.
    if (slips_are_sudden(slips)) {
      detected.begin = begin;
      detected.part = std::move(part);
      signals.quality = std::move(quality);
      signals.segmentation = std::move(slips);
    }
  }
  detected.seconds = stopwatch.elapsed_s();
  return detected;
}

}  // namespace slipfit
