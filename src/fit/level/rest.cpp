#include "fit/level/rest.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "fit/cycle/cycle_data.hpp"
#include "fit/level/add_hum.hpp"

namespace slipfit::fit {
namespace {

/// Neighbours are those between which fewer cycles than a run's are missing.
std::vector<CycleRun> runs_of(const Recording& recording, const BlockFit& fit) {
  const auto time_s = recording.time_s();
  const auto index_at = [&](double t_s) {
    return static_cast<std::size_t>(std::lower_bound(time_s.begin(), time_s.end(), t_s) - time_s.begin());
  };
  std::vector<CycleRun> runs;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const std::size_t end = index_at(fit.data(i).window_end_s);
    if (i == 0 || fit.data(i).slip - fit.data(i - 1).slip > kCyclesOfRun) {
      runs.push_back({index_at(fit.data(i).window_begin_s), end});
    }
    runs.back().end = end;
  }
  return runs;
}

/// Sums over samples of one frequency, phase counted from the first sample of the recording.
struct Correlation {
  double used = 0.0, cc = 0.0, cs = 0.0, rc = 0.0, rs = 0.0;

  /// Amplitude^2 of the least-squares sine.
  [[nodiscard]] double power() const {
    const double ss = used - cc;
    const double determinant = cc * ss - cs * cs;
    if (!(determinant > 0.0)) return 0.0;
    return (std::pow(rc * ss - rs * cs, 2) + std::pow(rs * cc - rc * cs, 2)) / (determinant * determinant);
  }
};

/// The phasor turns by a fixed step from sample to sample, four of them side by side.
void add_even(const double* values, std::size_t count, double phase, double step, Correlation& sums) {
  using Lanes = Eigen::Array4d;
  const double turn_c = std::cos(4.0 * step);
  const double turn_s = std::sin(4.0 * step);
  const Lanes phases = phase + step * Lanes(0.0, 1.0, 2.0, 3.0);
  Lanes c = phases.cos(), s = phases.sin();
  Lanes sum_cc = Lanes::Zero(), sum_cs = Lanes::Zero(), sum_rc = Lanes::Zero(), sum_rs = Lanes::Zero();
  Lanes sum_used = Lanes::Zero();
  for (std::size_t i = 0; i < count; i += 4) {
    Lanes r = Lanes::Zero();
    std::copy_n(values + i, std::min<std::size_t>(4, count - i), r.data());
    const Lanes present = (r.abs() * 1e300).min(1.0);  // r != 0, for which Eigen has no vector instruction
    sum_used += present;
    sum_cc += present * c * c;
    sum_cs += present * c * s;
    sum_rc += r * c;
    sum_rs += r * s;
    const Lanes next = c * turn_c - s * turn_s;
    s = c * turn_s + s * turn_c;
    c = next;
  }
  sums.used += sum_used.sum();
  sums.cc += sum_cc.sum();
  sums.cs += sum_cs.sum();
  sums.rc += sum_rc.sum();
  sums.rs += sum_rs.sum();
}

void add_uneven(const double* values, const double* time_s, std::size_t count, double begin_s, double omega,
                Correlation& sums) {
  for (std::size_t i = 0; i < count; ++i) {
    if (values[i] == 0.0) continue;
    const double c = std::cos(omega * (time_s[i] - begin_s));
    const double s = std::sin(omega * (time_s[i] - begin_s));
    sums.used += 1.0;
    sums.cc += c * c;
    sums.cs += c * s;
    sums.rc += values[i] * c;
    sums.rs += values[i] * s;
  }
}

/// Returns the step of the even clock that replaces an uneven one, in s. It is the mean step, or the usual one where
/// there are long gaps.
double even_step_s(const Recording& recording) {
  const auto size = static_cast<double>(recording.size());
  const double usual_s = std::min(recording.sample_interval_s(), recording.duration_s() / (size - 1.0));
  return std::max(usual_s, recording.duration_s() / (2.0 * size));  // gaps must not fill the memory
}

}  // namespace

Rest::Rest(const Recording& recording, const BlockFit& fit, std::vector<double> residuals)
    : recording_(recording), values_(std::move(residuals)), runs_(runs_of(recording, fit)) {}

double Rest::power_at(double frequency_Hz) const {
  const double omega = 2.0 * std::numbers::pi * frequency_Hz;
  const double step = omega * (recording_.duration_s() / static_cast<double>(values_.size() - 1));
  const auto time_s = recording_.time_s();
  Correlation sums;
  for (const CycleRun& run : runs_) {
    const std::size_t count = run.end - run.begin;
    if (count == 0) continue;
    if (recording_.clock_is_even()) {
      add_even(&values_[run.begin], count, step * static_cast<double>(run.begin), step, sums);
    } else {
      add_uneven(&values_[run.begin], &time_s[run.begin], count, time_s.front(), omega, sums);
    }
  }
  return sums.power();
}

/// Searches in steps of a quarter of a resolution, then takes the vertex of a parabola through the best three.
double Rest::refined(double frequency_Hz) const {
  constexpr int kSteps = 2;
  const double step_Hz = 0.25 * resolution_Hz();
  std::vector<double> powers;
  for (int i = -kSteps; i <= kSteps; ++i) powers.push_back(power_at(frequency_Hz + i * step_Hz));
  const auto best = static_cast<std::size_t>(std::max_element(powers.begin(), powers.end()) - powers.begin());
  double offset = static_cast<double>(best) - kSteps;
  if (best > 0 && best + 1 < powers.size()) {
    const double curvature = powers[best - 1] - 2.0 * powers[best] + powers[best + 1];
    if (curvature < 0.0) offset += 0.5 * (powers[best - 1] - powers[best + 1]) / curvature;
  }
  return frequency_Hz + offset * step_Hz;
}

EvenRest Rest::on_even_clock() const {
  if (recording_.clock_is_even()) {
    return {{}, values_, runs_, recording_.duration_s() / static_cast<double>(values_.size() - 1)};
  }
  const auto time_s = recording_.time_s();
  EvenRest even;
  even.step_s = even_step_s(recording_);
  const auto cell_of = [&](std::size_t sample) {
    return static_cast<std::size_t>(std::lround((time_s[sample] - time_s.front()) / even.step_s));
  };
  even.own.assign(cell_of(values_.size() - 1) + 1, 0.0);
  for (const CycleRun& run : runs_) {
    for (std::size_t i = run.begin; i < run.end; ++i) even.own[cell_of(i)] += values_[i];
    if (run.end > run.begin) even.runs.push_back({cell_of(run.begin), cell_of(run.end - 1) + 1});
  }
  even.values = even.own;
  return even;
}

void Rest::add_interference(const BlockFit& fit) {
  for (const CycleRun& run : runs_) add_hum(recording_, fit, run.begin, run.end, 1.0, values_);
}

}  // namespace slipfit::fit
