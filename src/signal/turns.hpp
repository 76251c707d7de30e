#pragma once

#include <algorithm>
#include <array>
#include <complex>
#include <cstddef>

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

}  // namespace slipfit::signal
