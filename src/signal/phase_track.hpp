#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <numbers>
#include <optional>
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

struct TrackedFrequency {
  double frequency_Hz = 0.0;
  double standard_error_Hz = 0.0;
  /// The standard error if the phases show no scatter of the periods: smaller, since it allows only for scatter that
  /// few cycles can conceal. It is empty if they show scatter, or if that was not tested.
  std::optional<double> regular_standard_error_Hz;
};

/// Mean frequency of a trace that repeats at about `near_Hz`, from the phase of its cycles. The phase is taken as a
/// random walk (a period that scatters) plus independent errors (noise): without a walk this is the harmonic
/// least-squares estimate, with a large one it is cycles counted over time; the data decide how much of either.
/// Empty: fewer than 6 usable cycles or no phase to follow.
std::optional<TrackedFrequency> track_frequency(const Recording& recording, double near_Hz, std::size_t harmonics);

/// Least squares of a harmonic series plus a straight line over the whole trace; for few cycles (the cost is cycles x
/// harmonics^3). The standard error allows for residuals correlated over up to one period. Empty: no convergence.
std::optional<TrackedFrequency> fit_harmonics(const Recording& recording, double near_Hz, std::size_t harmonics);

}  // namespace slipfit::signal
