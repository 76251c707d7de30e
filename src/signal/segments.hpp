#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

#include "slipfit/core/recording.hpp"

namespace slipfit::signal {

using Complex = std::complex<double>;
constexpr std::size_t kMostTracked = 10;
using Pattern = std::array<Complex, kMostTracked>;  ///< one coefficient a harmonic, fundamental first

/// Multiplies without the treatment of infinities in std::complex.
inline Complex multiply(Complex a, Complex b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// Fourier coefficients of one stretch of whole cycles.
struct Segment {
  double samples = 0.0;  ///< 0: too few for coefficients
  double sum = 0.0;
  Pattern lines{};
};

/// Coefficients of segments of `cycles` periods each, slow wander taken off. The first of many segments is left empty:
/// the first cycle starts at rest and differs.
std::vector<Segment> cut_segments(const Recording& recording, double frequency_Hz, double cycles,
                                  std::size_t harmonics);

/// The mean advance of the fundamental from one segment to the next, and its coherence (0 ... 1).
struct Advance {
  double radians = 0.0;
  double coherence = 0.0;
};

Advance advance_of(const std::vector<Segment>& segments);

/// Half as many segments of twice the length.
std::vector<Segment> merge_pairs(const std::vector<Segment>& segments, double advance_rad, std::size_t harmonics);

constexpr double kTurn = 2.0 * std::numbers::pi;

}  // namespace slipfit::signal
