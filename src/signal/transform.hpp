#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "slipfit/core/recording.hpp"

namespace slipfit::signal {

/// Force at equal steps of time.
struct UniformTrace {
  double step_s = 0.0;
  std::vector<double> force;
};

/// Linear interpolation onto the median step (gaps are bridged by a line), where the clock is not even as it is. `held`
/// samples are left out.
UniformTrace resample(const Recording& recording, const std::vector<bool>& held);

/// The recording as `resample` has it; empty where its clock is even. Sums that count each sample for as much time as
/// any other need it: a lost one would be a hole of its force, which is more than its noise.
std::optional<Recording> on_even_clock(const Recording& recording, const std::vector<bool>& held);

/// Every `factor`-th value, each a mean weighted by a triangle over the `factor` values on either side (so that what is
/// too fast for the new clock does not come back as something slow), less the first value.
std::vector<double> thin(std::span<const double> values, std::size_t factor);

/// Smallest even product of 2, 3, 5, 7 that is not below `length`.
std::size_t good_length(std::size_t length);

/// One-sided power of the linearly detrended, Hann-windowed, zero-padded values: bins 0 ... padded_length / 2; the sum
/// over the bins is the windowed variance, whatever the padding. `padded_length` from `good_length`.
std::vector<double> hann_power(std::span<const double> values, std::size_t padded_length);

}  // namespace slipfit::signal
