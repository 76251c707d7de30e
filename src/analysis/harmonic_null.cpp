#include "analysis/harmonic_null.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/statistics.hpp"
#include "signal/comb.hpp"

namespace slipfit {
namespace {

constexpr double kCycles = 5.0;  // in a window
constexpr std::size_t kMostWindows = 40;

struct Sum {
  double squares = 0.0;
  double freedom = 0.0;

  [[nodiscard]] double variance() const { return squares / freedom; }
  Sum& operator+=(const Sum& other) {
    squares += other.squares;
    freedom += other.freedom;
    return *this;
  }
};

struct Sums {
  Sum level;  ///< of a straight level
  Sum waves;  ///< of harmonics on it
};

/// Samples [begin, end) with harmonics of about this frequency, which is a parameter as well.
Sums residuals_of(const Recording& recording, std::size_t begin, std::size_t end, double frequency_Hz,
                  std::size_t harmonics) {
  constexpr int kSteps = 3;
  const std::size_t terms = 2 + 2 * harmonics + 1;  // level and slope, cosines and sines, frequency
  const auto count = static_cast<Eigen::Index>(end - begin);
  if (end - begin < 2 * terms) return {};
  const double middle_s = 0.5 * (recording.time_s()[begin] + recording.time_s()[end - 1]);
  const signal::Samples samples{Eigen::Map<const Eigen::VectorXd>(&recording.time_s()[begin], count).array() - middle_s,
                                Eigen::Map<const Eigen::VectorXd>(&recording.force()[begin], count),
                                Eigen::VectorXd::Ones(count)};
  double best = samples.force.squaredNorm();
  for (int i = 0; i < kSteps; ++i) {
    const signal::HarmonicStep step = signal::harmonic_step(samples, frequency_Hz, harmonics);
    best = std::min(best, step.residual.squaredNorm() - step.change_Hz * step.change_Hz * step.information);
    frequency_Hz *= std::clamp(1.0 + step.change_Hz / frequency_Hz, 0.8, 1.25);
  }
  const auto samples_in = static_cast<double>(count);
  const LineSums line =
      line_sums(recording.time_s().subspan(begin, end - begin), recording.force().subspan(begin, end - begin));
  return {{line.variance() * (samples_in - 2.0), samples_in - 2.0},
          {std::max(best, 0.0), samples_in - static_cast<double>(terms)}};
}

/// Returns the sums over windows of a few cycles each; nothing below 5 cycles.
std::optional<Sums> residuals_in_windows(const Recording& recording, double frequency_Hz, std::size_t harmonics) {
  const double window_s = kCycles / frequency_Hz;
  const auto fitting = static_cast<std::size_t>(recording.duration_s() / window_s);
  if (fitting == 0) return std::nullopt;
  const std::size_t windows = std::min(kMostWindows, fitting);
  const std::span<const double> time_s = recording.time_s();
  const double spare_s = recording.duration_s() - window_s;
  const auto sample_at = [&](double seconds) {
    return static_cast<std::size_t>(std::lower_bound(time_s.begin(), time_s.end(), seconds) - time_s.begin());
  };
  Sums all;
  for (std::size_t window = 0; window < windows; ++window) {
    const double share = static_cast<double>(window) / static_cast<double>(std::max<std::size_t>(1, windows - 1));
    const double begin_s = time_s.front() + share * spare_s;
    const auto [level, waves] =
        residuals_of(recording, sample_at(begin_s), sample_at(begin_s + window_s), frequency_Hz, harmonics);
    all.level += level;
    all.waves += waves;
  }
  return all.waves.freedom > 0.0 ? std::optional(all) : std::nullopt;
}

}  // namespace

std::optional<double> harmonic_residual_rms(const Recording& recording, double frequency_Hz) {
  constexpr std::size_t kHarmonics = 3;
  const std::optional<Sums> sums = residuals_in_windows(recording, frequency_Hz, kHarmonics);
  return sums ? std::optional(std::sqrt(sums->waves.variance())) : std::nullopt;
}

std::optional<double> share_of_sine(const Recording& recording, double frequency_Hz) {
  const std::optional<Sums> sums = residuals_in_windows(recording, frequency_Hz, 1);
  return sums ? std::optional(1.0 - sums->waves.variance() / sums->level.variance()) : std::nullopt;
}

}  // namespace slipfit
