#pragma once

#include <complex>
#include <cstddef>
#include <numbers>
#include <optional>

#include "slipfit/core/recording.hpp"

namespace slipfit::signal {

using Complex = std::complex<double>;

/// Multiplies without the treatment of infinities in std::complex.
inline Complex multiply(Complex a, Complex b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

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

}  // namespace slipfit::signal
