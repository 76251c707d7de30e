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

/// `scale`: of the slips, where it is known.
Part part_of(const Recording& recording, SampleRange stretch, std::optional<std::size_t> scale = std::nullopt) {
  Recording part = recording.part(stretch.begin, stretch.end);
  Quality quality = assess_quality(part);
  Segmentation slips = find_slips(part, quality, scale);
  return {std::move(part), std::move(quality), std::move(slips)};
}

/// Returns the scale at which the sliding part is analysed; it is that of the whole recording if the part is nearly all
/// of it.
std::optional<std::size_t> scale_of_part(const Segmentation& slips, std::size_t samples) {
  constexpr double kNearlyAll = 0.9;
  const auto sliding = static_cast<double>(slips.sliding_end - slips.sliding_begin);
  if (sliding < kNearlyAll * static_cast<double>(samples)) return std::nullopt;
  return slips.smoothed_over;
}

void take(Detected& detected, Part part, std::size_t begin) {
  detected.begin = begin;
  detected.part = std::move(part.recording);
  detected.signals.quality = std::move(part.quality);
  detected.signals.segmentation = std::move(part.slips);
}

/// Takes the stretch that slides: that of the slips where they are sudden, else the plateau of a steady run. A
/// ring-down is recognised by what follows it, waves and noise by the whole.
void narrow(Detected& detected) {
  const Recording& recording = detected.recording();
  const Segmentation& slips = detected.signals.segmentation;
  const SampleRange whole{0, recording.size()};
  const SampleRange sliding{slips.sliding_begin, slips.sliding_end};
  if (sliding != whole) {
    Part part = part_of(recording, sliding, scale_of_part(slips, recording.size()));
    if (slips_are_sudden(part.slips)) return take(detected, std::move(part), sliding.begin);
  } else if (slips_are_sudden(slips)) {
    return;
  }
  const SampleRange plateau = signal::plateau(recording.force());
  if (plateau != whole) take(detected, part_of(recording, plateau), plateau.begin);
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
