#include "analysis/conclusions.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/fit_thresholds.hpp"
#include "core/thresholds.hpp"
#include "signal/sinusoids.hpp"

namespace slipfit {
namespace {

constexpr double kStep = 0.25;           // of a wave, between two that are tried
constexpr std::size_t kMostSlips = 256;  // from the first on

/// Values at places between 0 and 1.
struct Series {
  Eigen::VectorXd place;
  Eigen::VectorXd value;

  [[nodiscard]] Eigen::Index size() const { return place.size(); }
};

/// A sine fitted to a series together with its mean and trend.
struct Sine {
  double waves = 0.0;
  double amplitude = 0.0;
  double rest = 1.0;  ///< share of the sum of squares about the trend that it leaves
};

Eigen::VectorXd without_trend(const Series& series) {
  Eigen::MatrixXd trend(series.size(), 2);
  trend << Eigen::VectorXd::Ones(series.size()), series.place;
  return series.value - trend * trend.colPivHouseholderQr().solve(series.value);
}

Sine sine_in(const Series& series, double waves) {
  const Eigen::MatrixXd columns = signal::line_and_harmonics(series.place, {.frequency_Hz = waves});
  const Eigen::VectorXd fitted = columns.colPivHouseholderQr().solve(series.value);
  const double all = without_trend(series).squaredNorm();
  const double rest = (series.value - columns * fitted).squaredNorm();
  return {waves, std::hypot(fitted[2], fitted[3]), all > 0.0 ? rest / all : 1.0};
}

/// Number of waves of the sine that explains most of a series. Three waves and more hardly correlate with its trend.
double best_waves(const Series& series) {
  const Eigen::ArrayXd value = without_trend(series);
  const std::complex<double> turn(0.0, 2.0 * std::numbers::pi);
  const Eigen::ArrayXcd step = (turn * kStep * series.place.array()).exp();
  Eigen::ArrayXcd wave = (turn * thresholds::kFewestWaves * series.place.array()).exp();
  double best = thresholds::kFewestWaves;
  double best_power = 0.0;
  const double most = thresholds::kMostWaves * static_cast<double>(series.size());
  for (double waves = thresholds::kFewestWaves; waves <= most; waves += kStep) {
    const double power = std::norm((wave * value).sum());
    if (power > best_power) best = waves;
    best_power = std::max(best_power, power);
    wave *= step;
  }
  return best;
}

/// Chance that white scatter leaves as small a residual with the best of all sines. Half as many of them as there are
/// values are independent.
double chance_of(const Sine& sine, const Series& series) {
  const auto count = static_cast<double>(series.size());
  return std::min(1.0, 0.5 * count * std::pow(sine.rest, 0.5 * (count - 4.0)));
}

/// Middle between peak and trough of each slip.
Series levels_of(std::span<const Cycle> cycles) {
  const auto count = static_cast<Eigen::Index>(cycles.size());
  Series levels{Eigen::VectorXd(count), Eigen::VectorXd(count)};
  const double span_s = cycles.back().peak_s - cycles.front().peak_s;
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    levels.place[row] = (cycles[i].peak_s - cycles.front().peak_s) / span_s;
    levels.value[row] = 0.5 * (cycles[i].peak_force + cycles[i].trough_force);
  }
  return levels;
}

/// Returns the differences of consecutive levels, which are white for a random walk.
Series differences_of(const Series& levels) {
  const Eigen::Index steps = levels.size() - 1;
  return {0.5 * (levels.place.head(steps) + levels.place.tail(steps)),
          levels.value.tail(steps) - levels.value.head(steps)};
}

double mean_drop(std::span<const Cycle> cycles) {
  double sum = 0.0;
  for (const Cycle& cycle : cycles) sum += cycle.peak_force - cycle.trough_force;
  return sum / static_cast<double>(cycles.size());
}

}  // namespace

std::optional<ShortTest> test_level_repeats(std::span<const Cycle> cycles, std::optional<double> speed_m_per_s) {
  if (cycles.size() < thresholds::kFewestOfLine) return std::nullopt;
  cycles = cycles.first(std::min(cycles.size(), kMostSlips));
  const auto count = static_cast<double>(cycles.size());
  const Series levels = levels_of(cycles);
  const Sine best = sine_in(levels, best_waves(levels));
  const double swing = 2.0 * best.amplitude / mean_drop(cycles);
  if (!(swing > thresholds::kSmallestWave)) {
    return ShortTest{
        TestKind::LevelRepeats,
        {},
        {},
        {},
        fmt::format(
            "no wave of the force level exceeds {:g} % of the mean drop, which sampling of the peaks alone causes",
            100.0 * thresholds::kSmallestWave)};
  }
  const Series differences = differences_of(levels);
  const double p = std::max(chance_of(best, levels), chance_of(sine_in(differences, best.waves), differences));
  const double period_s = (cycles.back().peak_s - cycles.front().peak_s) / best.waves;
  // Of the frequency of a sine in white scatter: sqrt(6 / n) sigma / (pi amplitude) waves
  const double scatter = std::sqrt(0.5 * best.rest / (1.0 - best.rest));
  const double relative = std::sqrt(6.0 / count) / std::numbers::pi * scatter / best.waves;
  std::optional<double> path_m, se_m;
  if (speed_m_per_s) {
    path_m = *speed_m_per_s * period_s;
    se_m = *path_m * relative;
  }
  const std::string path = path_m ? fmt::format(" or {:.3g} mm of sliding", 1e3 * *path_m) : "";
  const bool is_proven = p < thresholds::kProven;
  return ShortTest{TestKind::LevelRepeats, path_m, se_m, p,
                   fmt::format("the force level varies by {:.2g} % of the mean drop once every {:.3g} slips{}: {} at "
                               "the {:g} % level (p {:.2g}){}",
                               100.0 * swing, (count - 1.0) / best.waves, path, is_proven ? "proven" : "not proven",
                               100.0 * thresholds::kProven, p,
                               is_proven ? "; texture of the counterface repeats after the same displacement at every "
                                           "speed, a wave of the drive or the sensor after the same time"
                                         : "")};
}

}  // namespace slipfit
