#pragma once

#include <algorithm>
#include <array>
#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "slipfit/core/recording.hpp"

namespace slipfit::signal {

/// exp(i (start + k step)), k = 0, 1, ..., in blocks: that of the block's begin times those of the steps within it.
class Turns {
 public:
  static constexpr std::size_t kBlock = 64;

  Turns(double start, double step) : start_(start), step_(step) {
    for (std::size_t k = 0; k < kBlock; ++k) {
      const std::complex<double> within = std::polar(1.0, step * static_cast<double>(k));
      cosine_[k] = within.real();
      sine_[k] = within.imag();
    }
  }
  [[nodiscard]] std::complex<double> begin_of(std::size_t block) const {
    return std::polar(1.0, start_ + step_ * static_cast<double>(block * kBlock));
  }
  [[nodiscard]] double cosine(std::complex<double> begin, std::size_t k) const {
    return begin.real() * cosine_[k] - begin.imag() * sine_[k];
  }
  [[nodiscard]] double sine(std::complex<double> begin, std::size_t k) const {
    return begin.real() * sine_[k] + begin.imag() * cosine_[k];
  }

 private:
  double start_;
  double step_;
  std::array<double, kBlock> cosine_{};
  std::array<double, kBlock> sine_{};
};

/// Calls f(k, cosine, sine) of start + k step for k = 0 ... count - 1.
template <class F>
void for_turns(std::size_t count, double start, double step, const F& f) {
  const Turns turns(start, step);
  for (std::size_t begin = 0; begin < count; begin += Turns::kBlock) {
    const std::complex<double> turn = turns.begin_of(begin / Turns::kBlock);
    const std::size_t end = std::min(begin + Turns::kBlock, count);
    for (std::size_t k = begin; k < end; ++k) f(k, turns.cosine(turn, k - begin), turns.sine(turn, k - begin));
  }
}

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
