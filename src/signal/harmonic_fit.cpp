#include "signal/phase_track.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/student.hpp"
#include "signal/robust.hpp"
#include "signal/sinusoids.hpp"

namespace slipfit::signal {
namespace {

/// The trace in means of a few samples, time and force from their middles. Weights of Hann: without them the harmonics
/// that are left out pull at both ends (0.8 % at 4 cycles).
Samples thinned(const Recording& recording, double highest_Hz) {
  const std::span<const double> time = recording.time_s();
  const double step = recording.duration_s() / static_cast<double>(recording.size() - 1);
  const auto factor = static_cast<std::size_t>(std::max(1.0, 1.0 / (8.0 * highest_Hz * step)));
  const auto count = static_cast<Eigen::Index>(recording.size() / factor);
  Samples points{Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count)};
  const double middle = 0.5 * (time.front() + time.back());
  for (Eigen::Index row = 0; row < count; ++row) {
    for (std::size_t k = 0; k < factor; ++k) {
      const std::size_t i = static_cast<std::size_t>(row) * factor + k;
      points.time_s[row] += (time[i] - middle) / static_cast<double>(factor);
      points.force[row] += recording.force()[i] / static_cast<double>(factor);
    }
  }
  points.force.array() -= points.force.mean();
  points.weight = 1.0 + (2.0 * std::numbers::pi / recording.duration_s() * points.time_s.array()).cos();
  return points;
}

/// Noise of the residuals from their second differences, which see little of what varies slowly.
double noise_variance(const Eigen::VectorXd& residual) {
  std::vector<double> bends;
  for (Eigen::Index i = 1; i + 1 < residual.size(); ++i) {
    bends.push_back(std::abs(residual[i - 1] - 2.0 * residual[i] + residual[i + 1]));
  }
  const double rms = kMedianToSigma * median(std::move(bends)) / std::sqrt(6.0);
  return rms * rms;
}

/// Variance of the estimate: noise, and what the residuals show beyond it, summed over correlations up to a period
/// (Newey and West). The latter comes from periods that scatter, that is a phase that walks at random; of a walk the
/// straight line fitted to N cycles leaves N/15 of the variance of one step in the residuals, but is itself off by
/// 6/5 of it over N: 3/2 N times what independent errors of the size of the residuals would make.
double variance(const HarmonicStep& step, double cycles, double points_per_period) {
  const Eigen::VectorXd score = step.influence.cwiseProduct(step.residual);
  const Eigen::Index n = score.size();
  const Eigen::Index reach = std::min<Eigen::Index>(n - 1, static_cast<Eigen::Index>(points_per_period) + 1);
  double sum = score.squaredNorm();
  for (Eigen::Index lag = 1; lag < reach; ++lag) {
    const double weight = 1.0 - static_cast<double>(lag) / static_cast<double>(reach);
    sum += 2.0 * weight * score.head(n - lag).dot(score.tail(n - lag));
  }
  const double noise = step.influence.squaredNorm() * noise_variance(step.residual);
  const double widened = students_factor(cycles - 1.0);
  return 1.2 * noise + widened * widened * 1.5 * cycles * std::max(0.0, sum - noise);
}

}  // namespace

std::optional<TrackedFrequency> fit_harmonics(const Recording& recording, double near_Hz, std::size_t harmonics) {
  const Samples points = thinned(recording, near_Hz * static_cast<double>(harmonics));
  if (points.time_s.size() < static_cast<Eigen::Index>(2 * harmonics + 6)) return std::nullopt;
  const double resolution_Hz = 1.0 / recording.duration_s();
  double frequency = near_Hz;
  for (int pass = 0; pass < 12; ++pass) {
    const HarmonicStep step = harmonic_step(points, frequency, harmonics);
    const double change = std::clamp(step.change_Hz, -0.1 * resolution_Hz, 0.1 * resolution_Hz);
    frequency += change;
    if (!std::isfinite(frequency) || std::abs(frequency - near_Hz) > 0.7 * resolution_Hz) return std::nullopt;
    if (std::abs(change) < 1e-5 * resolution_Hz) {
      const double per_period = static_cast<double>(points.time_s.size()) * resolution_Hz / frequency;
      const double error = std::sqrt(variance(step, frequency / resolution_Hz, per_period));
      return TrackedFrequency{frequency, error, std::nullopt};
    }
  }
  return std::nullopt;
}

}  // namespace slipfit::signal
