#include "analysis/harmonic_null.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "signal/comb.hpp"

namespace slipfit {
namespace {

constexpr double kCycles = 5.0;  // in a window
constexpr std::size_t kMostWindows = 40;
constexpr std::size_t kHarmonics = 3;
constexpr std::size_t kTerms = 2 + 2 * kHarmonics + 1;  // level and slope, cosines and sines, frequency

struct Sum {
  double squares = 0.0;
  double freedom = 0.0;
};

/// Samples [begin, end) with harmonics of about this frequency, which is a parameter as well.
Sum residual_of(const Recording& recording, std::size_t begin, std::size_t end, double frequency_Hz) {
  constexpr int kSteps = 3;
  const auto count = static_cast<Eigen::Index>(end - begin);
  if (end - begin < 2 * kTerms) return {};
  const double middle_s = 0.5 * (recording.time_s()[begin] + recording.time_s()[end - 1]);
  const signal::Samples samples{Eigen::Map<const Eigen::VectorXd>(&recording.time_s()[begin], count).array() - middle_s,
                                Eigen::Map<const Eigen::VectorXd>(&recording.force()[begin], count),
                                Eigen::VectorXd::Ones(count)};
  double best = samples.force.squaredNorm();
  for (int i = 0; i < kSteps; ++i) {
    const signal::HarmonicStep step = signal::harmonic_step(samples, frequency_Hz, kHarmonics);
    best = std::min(best, step.residual.squaredNorm() - step.change_Hz * step.change_Hz * step.information);
    frequency_Hz *= std::clamp(1.0 + step.change_Hz / frequency_Hz, 0.8, 1.25);
  }
  return {std::max(best, 0.0), static_cast<double>(end - begin - kTerms)};
}

}  // namespace

std::optional<double> harmonic_residual_rms(const Recording& recording, double frequency_Hz) {
  const double window_s = kCycles / frequency_Hz;
  const auto fitting = static_cast<std::size_t>(recording.duration_s() / window_s);
  if (fitting == 0) return std::nullopt;
  const std::size_t windows = std::min(kMostWindows, fitting);
  const std::span<const double> time_s = recording.time_s();
  const double spare_s = recording.duration_s() - window_s;
  const auto sample_at = [&](double seconds) {
    return static_cast<std::size_t>(std::lower_bound(time_s.begin(), time_s.end(), seconds) - time_s.begin());
  };
  Sum all;
  for (std::size_t window = 0; window < windows; ++window) {
    const double share = static_cast<double>(window) / static_cast<double>(std::max<std::size_t>(1, windows - 1));
    const double begin_s = time_s.front() + share * spare_s;
    const Sum sum = residual_of(recording, sample_at(begin_s), sample_at(begin_s + window_s), frequency_Hz);
    all.squares += sum.squares;
    all.freedom += sum.freedom;
  }
  if (!(all.freedom > 0.0)) return std::nullopt;
  return std::sqrt(all.squares / all.freedom);
}

}  // namespace slipfit
