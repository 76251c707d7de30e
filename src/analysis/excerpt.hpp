#pragma once

#include <cstddef>

#include "slipfit/core/recording.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit {

/// A part of a recording with its quality and slips, as found in the whole.
struct Excerpt {
  Recording recording;
  Quality quality;
  Segmentation segmentation;
};

/// So many neighbouring slips from the middle of a recording that has two more.
Excerpt excerpt_of(const Recording& recording, const Quality& quality, const Segmentation& segmentation,
                   std::size_t slips);

}  // namespace slipfit
