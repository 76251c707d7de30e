#include "analysis/excerpt.hpp"

#include <cassert>

namespace slipfit {

Excerpt excerpt_of(const Recording& recording, const Quality& quality, const Segmentation& segmentation,
                   std::size_t slips) {
  const std::vector<DetectedSlip>& all = segmentation.slips;
  assert(all.size() >= slips + 2);
  const auto first = static_cast<std::ptrdiff_t>((all.size() - slips) / 2);
  const auto last = first + static_cast<std::ptrdiff_t>(slips);
  const std::size_t begin = (all.begin() + first - 1)->trough;
  const std::size_t end = (all.begin() + last)->peak + 1;
  Excerpt excerpt{recording.part(begin, end), quality, segmentation};
  if (!quality.impulse_mask.empty()) {
    const auto mask = quality.impulse_mask.begin();
    excerpt.quality.impulse_mask.assign(mask + static_cast<std::ptrdiff_t>(begin),
                                        mask + static_cast<std::ptrdiff_t>(end));
  }
  excerpt.segmentation.slips.assign(all.begin() + first, all.begin() + last);
  for (DetectedSlip& slip : excerpt.segmentation.slips) {
    slip.peak -= begin;
    slip.trough -= begin;
  }
  excerpt.segmentation.sliding_begin = 0;
  excerpt.segmentation.sliding_end = end - begin;
  return excerpt;
}

}  // namespace slipfit
