#include "analysis/detect.hpp"

#include <utility>

#include "analysis/slip_shape.hpp"
#include "signal/defects.hpp"
#include "signal/stretch.hpp"

namespace slipfit {
namespace {

/// Quality and slips of a part of what is read.
struct Part {
  Recording recording;
  Quality quality;
  Segmentation slips;
};

Part part_of(const Recording& recording, signal::Stretch stretch) {
  Recording part = recording.part(stretch.begin, stretch.end);
  Quality quality = assess_quality(part);
  Segmentation slips = find_slips(part, quality);
  return {std::move(part), std::move(quality), std::move(slips)};
}

void take(Detected& detected, Part part, std::size_t begin) {
  detected.begin = begin;
  detected.part = std::move(part.recording);
  detected.signals.quality = std::move(part.quality);
  detected.signals.segmentation = std::move(part.slips);
}

/// Takes the stretch that slides: that of the slips where they are sudden, else the plateau of a steady run. A
/// ring-down is told by what comes after it, waves and noise by the whole.
void narrow(Detected& detected) {
  const Recording& recording = detected.recording();
  const Segmentation& slips = detected.signals.segmentation;
  const auto is_whole = [&](signal::Stretch s) { return s.begin == 0 && s.end == recording.size(); };
  const signal::Stretch sliding{slips.sliding_begin, slips.sliding_end};
  if (!is_whole(sliding)) {
    Part part = part_of(recording, sliding);
    if (slips_are_sudden(part.slips)) return take(detected, std::move(part), sliding.begin);
  } else if (slips_are_sudden(slips)) {
    return;
  }
  const signal::Stretch plateau = signal::plateau(recording.force());
  if (!is_whole(plateau)) take(detected, part_of(recording, plateau), plateau.begin);
}

}  // namespace

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
  if (!recording.provenance().window_given) narrow(detected);
  detected.seconds = stopwatch.elapsed_s();
  return detected;
}

}  // namespace slipfit
