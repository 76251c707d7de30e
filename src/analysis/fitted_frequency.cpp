#include "analysis/fitted_frequency.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/line_sums.hpp"
#include "core/student.hpp"
#include "signal/robust.hpp"

namespace slipfit {
namespace {

struct Onset {
  double index = 0.0;  ///< number of the cycle, missing ones counted
  double time_s = 0.0;
  std::optional<double> counted;  ///< steps from the one before by the table, where cycles between were left aside
};

std::vector<Onset> onsets_of(const FitResult& fit) {
  std::vector<Onset> onsets;
  std::vector<double> steps_s;
  double rows = 1.0;
  bool aside = false;
  for (const Cycle& cycle : fit.cycles) {
    aside = aside || !cycle.selected;
    if (cycle.used && !onsets.empty()) steps_s.push_back((*cycle.onset_s - onsets.back().time_s) / rows);
    if (cycle.used) onsets.push_back({0.0, *cycle.onset_s, aside ? std::optional(rows) : std::nullopt});
    if (cycle.used) aside = false;
    rows = cycle.used ? 1.0 : rows + 1.0;
  }
  const double period_s = signal::median(std::move(steps_s));
  for (std::size_t i = 1; i < onsets.size(); ++i) {
    // From one to the next: a period that drifts does not add up. Over many cycles that scatter only counting helps.
    const double steps = std::round((onsets[i].time_s - onsets[i - 1].time_s) / period_s);
    onsets[i].index = onsets[i - 1].index + onsets[i].counted.value_or(std::max(1.0, steps));
  }
  return onsets;
}

/// Slope of the least-squares line through the onsets, and its standard error: larger where neighbours err together
/// (short sticks hand their errors on).
struct Line {
  double period_s = 0.0;
  double standard_error_s = 0.0;
};

Line line_through(const std::vector<Onset>& onsets) {
  const LineSums line = line_sums(
      onsets.size(), [&](std::size_t i) { return onsets[i].index; }, [&](std::size_t i) { return onsets[i].time_s; });
  double rest = 0.0, product = 0.0, previous_s = 0.0;
  for (const Onset& onset : onsets) {
    const double residual_s = onset.time_s - line.at(onset.index);
    rest += residual_s * residual_s;
    product += residual_s * previous_s;
    previous_s = residual_s;
  }
  const double correlation = rest > 0.0 ? std::clamp(product / rest, 0.0, 0.9) : 0.0;
  const double fewer = (1.0 + correlation) / (1.0 - correlation);
  return {line.slope(), std::sqrt(fewer * rest / (line.count - 2.0) / line.square)};
}

/// Whether onset forces differ no more than their errors, and neighbouring periods are correlated as those of even
/// onsets, each timed with an error of its own, are
/// (-1/2, with a standard error of 0.7 / sqrt(count)); where the static friction scatters they come near +1/2.
bool is_regular(const FitDiagnostics& diagnostics, const std::vector<Onset>& onsets, double period_s) {
  constexpr double kOrdinarySpread = 2.0;  // over its expectation: beyond chance from 10 cycles on
  if (diagnostics.onset_force_spread > kOrdinarySpread * diagnostics.onset_force_error) return false;
  double product = 0.0, square = 0.0, previous = 0.0, count = 0.0;
  for (std::size_t i = 1; i < onsets.size(); ++i) {
    const double steps = onsets[i].index - onsets[i - 1].index;
    const double deviation = steps == 1.0 ? onsets[i].time_s - onsets[i - 1].time_s - period_s : 0.0;
    square += deviation * deviation;
    product += deviation * previous;
    previous = deviation;
    count += 1.0;
  }
  return product <= (-0.5 + 0.9 / std::sqrt(count)) * square;
}

/// Standard error over mean of the time that a slip's drop takes to build up again, on average over the cycles in the
/// fit and those left aside, which scatter alike.
double recovery_error(const FitResult& fit) {
  double count = 0.0, mean = 0.0, square = 0.0, aside = 0.0;
  for (const Cycle& cycle : fit.cycles) {
    if (!cycle.selected) aside += 1.0;
    if (!cycle.used) continue;
    count += 1.0;
    const double step = *cycle.recovery_s - mean;
    mean += step / count;
    square += step * (*cycle.recovery_s - mean);
  }
  return std::sqrt(square / (count - 1.0) / (count + aside)) / mean;
}

Estimate with_relative_error(double value, double relative_error, double degrees_of_freedom) {
  return symmetric(value, relative_error * value, degrees_of_freedom);
}

}  // namespace

std::optional<Estimate> fitted_frequency(const FitResult& fit, const Recording& recording) {
  constexpr std::size_t kFewest = 5;
  constexpr double kSampled = 6.0;
  const std::vector<Onset> onsets = onsets_of(fit);
  if (onsets.size() < kFewest) return std::nullopt;
  const auto count = static_cast<double>(onsets.size());
  const Line line = line_through(onsets);
  // The first and the last slip are timed to a step of the clock, evenly distributed.
  const double mean_s = (onsets.back().time_s - onsets.front().time_s) / onsets.back().index;
  const double timing = recording.sample_interval_s() / mean_s / std::sqrt(6.0) / count;
  if (!is_regular(fit.diagnostics, onsets, line.period_s)) {
    return with_relative_error(1.0 / mean_s, std::hypot(recovery_error(fit), timing), count - 1.0);
  }
  // Between two samples of a hardly sampled slip the errors of regular cycles are no chance: they repeat.
  if (fit.diagnostics.samples_per_slip < kSampled) return std::nullopt;
  // Jumps of a sensor at the contact are timed to a step, and the error of regular ones may repeat.
  const double step = recording.conditions().force_view == ForceView::Contact ? 0.5 * timing : 0.0;
  return with_relative_error(1.0 / line.period_s, std::hypot(line.standard_error_s / line.period_s, step), count - 2.0);
}

}  // namespace slipfit
