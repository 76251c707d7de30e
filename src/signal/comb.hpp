#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "signal/phase_track.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit::signal {

/// Power times frequency of a spectrum, ready for means over any band. (Times frequency, because the mean of the two
/// gaps next to a line then equals the background under it for white noise and for 1/f, and exceeds it for 1/f^2.)
class BandPower {
 public:
  /// Computes the power in bands. `resolution_Hz` is one over the duration; the bins may be finer (zero padding).
  BandPower(std::span<const double> power, double bin_Hz, double resolution_Hz);

  [[nodiscard]] double mean(double low_Hz, double high_Hz) const {
    const double low = std::max(0.0, low_Hz * per_bin_ + 0.5);
    const double high = high_Hz * per_bin_ + 0.5;
    return (tail(low) - tail(high)) / std::max(1e-3, high - low);
  }
  /// Shape of the gamma distribution that such a mean follows in noise (Hann: neighbouring bins correlate).
  [[nodiscard]] double shape(double width_Hz) const;
  [[nodiscard]] double resolution_Hz() const { return resolution_Hz_; }
  [[nodiscard]] double highest_Hz() const { return bin_Hz_ * last_; }

 private:
  [[nodiscard]] double tail(double edge) const {
    const double place = std::min(std::max(edge, 0.0), last_);
    const auto below = std::min(static_cast<std::size_t>(place), tail_.size() - 2);
    return tail_[below] + (place - static_cast<double>(below)) * (tail_[below + 1] - tail_[below]);
  }

  double bin_Hz_;
  double per_bin_;
  double last_;
  double resolution_Hz_;
  std::vector<double> tail_;  ///< sum over the bins from i up: the faint ones first, so that they keep their digits
};

/// Lines at multiples of one frequency, each against the gaps on either side of it.
struct Comb {
  static constexpr std::size_t kMostHarmonics = 10;

  double frequency_Hz = 0.0;
  double relative_width = 0.0;                 ///< half width of the lines over their frequency; 0: as sharp as can be
  std::size_t harmonics = 0;                   ///< that make the score largest
  double score = 0.0;                          ///< sum of ln(line / gaps) in its standard deviations in noise
  double false_alarm_probability = 1.0;        ///< that noise shows such a comb anywhere in the searched range
  std::size_t measured = 0;                    ///< harmonics below the highest frequency
  std::array<double, kMostHarmonics> ratio{};  ///< line / gaps
  std::array<double, kMostHarmonics> line_shape{};  ///< of the gamma distributions
  std::array<double, kMostHarmonics> gap_shape{};
  std::array<double, kMostHarmonics> power{};  ///< of the line above its gaps, (unit of force)^2
};

struct CombRange {
  double low_Hz = 0.0;
  double high_Hz = 0.0;
};

/// The combs worth a look in the range, their false-alarm probability included. `fine`: on a grid finer than the
/// resolution (few cycles, oversampled spectrum); otherwise from the significant peaks.
enum class CombGrid { Fine, Peaks };
std::vector<Comb> search_combs(const BandPower& bands, CombRange range, CombGrid grid);

/// Comb at one frequency: ratios and score, no false-alarm probability.
Comb measure_comb(const BandPower& bands, double frequency_Hz, double relative_width);

/// Returns the comb with the highest score, if above 0, of those at frequency_at(-reach), ..., frequency_at(reach).
template <class FrequencyAt>
Comb best_comb(const BandPower& bands, int reach, double relative_width, const FrequencyAt& frequency_at) {
  Comb best;
  for (int step = -reach; step <= reach; ++step) {
    const Comb there = measure_comb(bands, frequency_at(step), relative_width);
    if (there.score > best.score) best = there;
  }
  return best;
}

/// The samples to which harmonics are fitted; times relative to the middle decorrelate a line and the frequency.
struct Samples {
  Eigen::VectorXd time_s;
  Eigen::VectorXd force;
  Eigen::VectorXd weight;
};

/// Holds what a fundamental and its harmonics share: each has a multiple of the frequency and exp(-decay t).
struct Oscillation {
  double frequency_Hz = 0.0;
  std::size_t harmonics = 1;
  double decay_per_s = 0.0;
};

/// Columns 1, t, then cosine and sine of each harmonic.
Eigen::MatrixXd line_and_harmonics(const Eigen::VectorXd& time_s, const Oscillation& oscillation);

/// A weighted least-squares fit of a line and harmonics at a given frequency and decay.
class HarmonicFit {
 public:
  /// `samples` outlive the fit.
  HarmonicFit(const Samples& samples, const Oscillation& oscillation);

  [[nodiscard]] const Eigen::MatrixXd& columns() const { return columns_; }
  [[nodiscard]] Eigen::VectorXd residual() const { return samples_.force - columns_ * coefficients_; }
  /// Returns the derivative of the fitted force by the frequency in Hz.
  [[nodiscard]] Eigen::VectorXd by_frequency() const;
  /// Returns the derivative of the fitted force by the decay.
  [[nodiscard]] Eigen::VectorXd by_decay() const;
  /// Returns what the columns cannot explain of values.
  [[nodiscard]] Eigen::VectorXd without_columns(const Eigen::VectorXd& values) const;

 private:
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& values) const;

  const Samples& samples_;
  Eigen::MatrixXd columns_;
  Eigen::MatrixXd weighted_;
  Eigen::LDLT<Eigen::MatrixXd> normal_;
  Eigen::VectorXd coefficients_;
};

/// One Gauss-Newton step of a least-squares fit of a line and harmonics, whose frequency is a parameter as well.
struct HarmonicStep {
  double change_Hz = 0.0;
  double information = 0.0;   ///< weighted sum of squares of the derivative by the frequency, without the other columns
  Eigen::VectorXd residual;   ///< at the frequency before the step
  Eigen::VectorXd influence;  ///< change of the frequency for a unit change of each sample
};
HarmonicStep harmonic_step(const Samples& samples, double frequency_Hz, std::size_t harmonics);

/// Least squares of a harmonic series plus a straight line over the whole trace; for few cycles (the cost is cycles x
/// harmonics^3). The standard error allows for residuals correlated over up to one period. Empty: no convergence.
std::optional<TrackedFrequency> fit_harmonics(const Recording& recording, double near_Hz, std::size_t harmonics);

}  // namespace slipfit::signal
