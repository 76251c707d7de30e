#include "analysis/harmonic_null.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace slipfit {
namespace {

constexpr std::size_t kCycles = 5;  // in a window
constexpr std::size_t kMostWindows = 40;
constexpr Eigen::Index kHarmonics = 3;
constexpr Eigen::Index kTerms = 2 + 2 * kHarmonics;

struct Sum {
  double squares = 0.0;
  double freedom = 0.0;
};

/// Samples [begin, end) with this period.
Sum residual_of(const Recording& recording, std::size_t begin, std::size_t end, double period_s) {
  const auto count = static_cast<Eigen::Index>(end - begin);
  if (count <= 2 * kTerms) return {};
  Eigen::MatrixXd terms(count, kTerms);
  Eigen::VectorXd force(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::size_t sample = begin + static_cast<std::size_t>(i);
    const double cycles = (recording.time_s()[sample] - recording.time_s()[begin]) / period_s;
    force(i) = recording.force()[sample];
    terms(i, 0) = 1.0;
    terms(i, 1) = cycles;
    for (Eigen::Index h = 1; h <= kHarmonics; ++h) {
      const double phase = 2.0 * std::numbers::pi * static_cast<double>(h) * cycles;
      terms(i, 2 * h) = std::cos(phase);
      terms(i, 2 * h + 1) = std::sin(phase);
    }
  }
  const Eigen::VectorXd best = (terms.transpose() * terms).ldlt().solve(terms.transpose() * force);
  return {(force - terms * best).squaredNorm(), static_cast<double>(count - kTerms)};
}

}  // namespace

std::optional<double> harmonic_residual_rms(const Recording& recording, const Segmentation& segmentation) {
  const std::vector<DetectedSlip>& slips = segmentation.slips;
  if (slips.size() <= kCycles) return std::nullopt;
  const std::size_t windows = std::min(kMostWindows, (slips.size() - 1) / kCycles);
  Sum all;
  for (std::size_t window = 0; window < windows; ++window) {
    const std::size_t first = window * (slips.size() - 1 - kCycles) / std::max<std::size_t>(1, windows - 1);
    const DetectedSlip& from = slips[std::min(first, slips.size() - 1 - kCycles)];
    const DetectedSlip& to = slips[std::min(first, slips.size() - 1 - kCycles) + kCycles];
    const double period_s = (to.middle_s - from.middle_s) / static_cast<double>(kCycles);
    if (!(period_s > 0.0)) continue;
    const Sum sum = residual_of(recording, from.peak, to.peak, period_s);
    all.squares += sum.squares;
    all.freedom += sum.freedom;
  }
  if (!(all.freedom > 0.0)) return std::nullopt;
  return std::sqrt(all.squares / all.freedom);
}

}  // namespace slipfit
