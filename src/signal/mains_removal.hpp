#pragma once

#include <vector>

#include "slipfit/core/recording.hpp"

namespace slipfit::signal {

/// The force without lines of the mains, for looking at, not for fitting: cosine and sine of each under a Hann window,
/// which keeps the cycles' own lines out.
struct Dehummed {
  std::vector<double> lines_Hz;  ///< empty: none stands out, the clock is uneven, or the mains is slower than 4 turns
  std::vector<double> force;
  double swing = 0.0;  ///< peak to peak, the largest line
};

Dehummed without_mains(const Recording& recording);

}  // namespace slipfit::signal
