#include "analysis/harmonic_null.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

namespace slipfit {
namespace {

constexpr double kCycles = 5.0;  // in a window
constexpr std::size_t kMostWindows = 40;
constexpr Eigen::Index kHarmonics = 3;
constexpr Eigen::Index kTerms = 2 + 2 * kHarmonics;  // level and slope, cosines and sines

using Products = Eigen::Matrix<double, kTerms + 1, kTerms + 1>;

struct Sum {
  double squares = 0.0;
  double freedom = 0.0;
};

/// Level, cosines and sines at this phase of the first harmonic. The higher ones by multiplication: a cosine costs more
/// than all else that a sample takes here.
void put_waves(const Eigen::ArrayXd& phase, Eigen::Matrix<double, Eigen::Dynamic, kTerms + 1>& terms) {
  terms.col(0).setOnes();
  terms.col(2) = phase.cos();
  terms.col(3) = phase.sin();
  const auto cosine = terms.col(2).array();
  const auto sine = terms.col(3).array();
  for (Eigen::Index h = 2; h <= kHarmonics; ++h) {
    const auto last_cosine = terms.col(2 * h - 2).array();
    const auto last_sine = terms.col(2 * h - 1).array();
    terms.col(2 * h) = last_cosine * cosine - last_sine * sine;
    terms.col(2 * h + 1) = last_sine * cosine + last_cosine * sine;
  }
}

/// Samples [begin, end) with harmonics of about this period, which is a parameter as well: a step of it turns harmonic
/// h in proportion to h and to the time.
Sum residual_of(const Recording& recording, std::size_t begin, std::size_t end, double period_s) {
  constexpr int kSteps = 3;
  const auto count = static_cast<Eigen::Index>(end - begin);
  if (count <= 2 * kTerms) return {};
  Eigen::Matrix<double, Eigen::Dynamic, kTerms + 1> terms(count, kTerms + 1);
  Eigen::VectorXd force(count), time_s(count);
  const double middle_s = 0.5 * (recording.time_s()[begin] + recording.time_s()[end - 1]);
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::size_t sample = begin + static_cast<std::size_t>(i);
    force(i) = recording.force()[sample];
    time_s(i) = recording.time_s()[sample] - middle_s;
  }
  double best = force.squaredNorm();
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::ArrayXd phase = (2.0 * std::numbers::pi / period_s) * time_s.array();
    put_waves(phase, terms);
    terms.col(1) = time_s / period_s;
    const auto fixed = terms.leftCols<kTerms>();
    Products normal;
    normal.topLeftCorner<kTerms, kTerms>() = fixed.transpose() * fixed;
    Eigen::Matrix<double, kTerms + 1, 1> right;
    right.head<kTerms>() = fixed.transpose() * force;
    const Eigen::Vector<double, kTerms> waves =
        normal.topLeftCorner<kTerms, kTerms>().ldlt().solve(right.head<kTerms>());
    Eigen::Vector<double, kTerms> turning = Eigen::Vector<double, kTerms>::Zero();
    for (Eigen::Index h = 1; h <= kHarmonics; ++h) {
      turning(2 * h) = static_cast<double>(h) * waves(2 * h + 1);
      turning(2 * h + 1) = -static_cast<double>(h) * waves(2 * h);
    }
    terms.col(kTerms) = phase * (fixed * turning).array();
    normal.col(kTerms) = terms.transpose() * terms.col(kTerms);
    normal.row(kTerms) = normal.col(kTerms).transpose();
    right(kTerms) = terms.col(kTerms).dot(force);
    const Eigen::Vector<double, kTerms + 1> all = normal.ldlt().solve(right);
    best = std::min(best, (force - terms * all).squaredNorm());
    period_s /= std::clamp(1.0 + all(kTerms), 0.8, 1.25);
  }
  return {best, static_cast<double>(count - kTerms - 1)};
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
    const Sum sum = residual_of(recording, sample_at(begin_s), sample_at(begin_s + window_s), 1.0 / frequency_Hz);
    all.squares += sum.squares;
    all.freedom += sum.freedom;
  }
  if (!(all.freedom > 0.0)) return std::nullopt;
  return std::sqrt(all.squares / all.freedom);
}

}  // namespace slipfit
