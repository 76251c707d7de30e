#include "analysis/conclusions.hpp"

#include <fmt/format.h>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "report/names.hpp"
#include "signal/comb.hpp"
#include "signal/least_squares.hpp"
#include "slipfit/core/range.hpp"

namespace slipfit {

namespace {

/// The quantities that a wrong unit (by a factor of 1000) makes implausible. The ranges include, with a decade to
/// spare, measured recordings and data sheets: springs and load cells of 0.1 kN/m to 100 MN/m, moving bodies of 0.1 g
/// to 1 t, slips of 10 nm (a thousandth of that is allowed) to 20 mm.
struct Seen {
  std::optional<double> stiffness_N_per_m;
  std::optional<double> mass_kg;
  std::optional<double> spacing_m;
};

constexpr Range kStiffness_N_per_m{10.0, 1e9};
constexpr Range kMass_kg{1e-5, 1e4};
constexpr Range kSpacing_m{1e-9, 0.2};

bool is_outside(const std::optional<double>& value, const Range& range) {
  return value && !(*value >= range.low && *value <= range.high);
}

bool is_plausible(const Seen& seen) {
  return !is_outside(seen.stiffness_N_per_m, kStiffness_N_per_m) && !is_outside(seen.mass_kg, kMass_kg) &&
         !is_outside(seen.spacing_m, kSpacing_m);
}

/// A mistaken unit: what the true numbers are of those seen, and what to ask the user. Without a unit of the clock in
/// the file the clock is the first suspect.
struct Mistake {
  double stiffness = 1.0;
  double mass = 1.0;
  double spacing = 1.0;
  const char* question = "";
  bool is_of_clock = false;
};

constexpr std::array kMistakes = std::to_array<Mistake>({
    {1e3, 1e3, 1e-3, "is the speed in mm/s, 1000 times smaller?"},
    {1e3, 1e-3, 1e-3, "is the time in ms (--time-unit ms)?", true},
    {1e6, 1e-6, 1e-6, "is the time in us (--time-unit us)?", true},
    {1e-3, 1e-3, 1.0, "is the force in mN (--force-unit mN)?"},
    {1e3, 1e3, 1.0, "is the force in kN (--force-unit kN)?"},
    {1e-3, 1e-3, 1e3, "is the speed in m/s, 1000 times larger?"},
});

std::optional<double> scaled(const std::optional<double>& value, double factor) {
  return value ? std::optional(*value * factor) : std::nullopt;
}

std::string remedy_for(const Seen& seen, bool is_time_unit_assumed) {
  std::vector<Mistake> mistakes(kMistakes.begin(), kMistakes.end());
  if (is_time_unit_assumed)
    std::stable_partition(mistakes.begin(), mistakes.end(), [](const Mistake& mistake) { return mistake.is_of_clock; });
  for (const Mistake& mistake : mistakes) {
    if (is_plausible({scaled(seen.stiffness_N_per_m, mistake.stiffness), scaled(seen.mass_kg, mistake.mass),
                      scaled(seen.spacing_m, mistake.spacing)})) {
      return (is_time_unit_assumed && mistake.is_of_clock ? "the file contains no unit of time: " : "") +
             std::string(mistake.question);
    }
  }
  return "check the units of speed, time and force";
}

}  // namespace

std::optional<std::string> implausible_units(const Recording& recording, const Analysis& analysis) {
  const bool has_slips = analysis.motion == MotionClass::StickSlip || analysis.motion == MotionClass::OscillatorySlip;
  if (recording.conditions().quantity != ForceQuantity::Force_N || !has_slips) return std::nullopt;
  Seen seen{analysis.cycles.stick_stiffness.value, std::nullopt, analysis.derived.pattern_spacing_m.value};
  if (const Parameter* const mass = analysis.fit ? analysis.fit->find(ParameterId::Mass) : nullptr) {
    if (mass->status != ParameterStatus::Bounded) seen.mass_kg = mass->estimate.value;
  }
  if (is_plausible(seen)) return std::nullopt;
  std::string what;
  const auto add = [&what](const std::optional<double>& value, const Range& range, const char* words,
                           const char* unit) {
    if (is_outside(value, range)) what += fmt::format("{}{} {:.3g} {}", what.empty() ? "" : ", ", words, *value, unit);
  };
  add(seen.stiffness_N_per_m, kStiffness_N_per_m, "a stiffness of", "N/m");
  add(seen.mass_kg, kMass_kg, "a mass of", "kg");
  add(seen.spacing_m, kSpacing_m, "a distance per slip of", "m");
  return fmt::format("the results are outside the range of tribometers ({}): {}", what,
                     remedy_for(seen, recording.provenance().is_time_unit_assumed));
}

namespace {

/// A cycle and the one before it, both fitted.
struct Pair {
  double time_s = 0.0;
  double period_s = 0.0;  ///< that the slip causes, and so a function of its own static friction alone
  double force = 0.0;     ///< onset force above the level
  double force_before = 0.0;
  double log_stick = 0.0;  ///< ln of the time in stick between them
};

std::vector<Pair> pairs_of(const std::vector<Cycle>& cycles) {
  std::vector<Pair> pairs;
  for (std::size_t i = 1; i < cycles.size(); ++i) {
    const Cycle& before = cycles[i - 1];
    const Cycle& cycle = cycles[i];
    if (!before.used || !cycle.used || !cycle.recovery_s) continue;
    const double stick_s = *cycle.onset_s - *before.end_s;
    if (!(stick_s > 0.0)) continue;
    pairs.push_back({*cycle.onset_s, *cycle.recovery_s, *cycle.onset_force - *cycle.level_force,
                     *before.onset_force - *before.level_force, std::log(stick_s)});
  }
  return pairs;
}

using Column = std::vector<double>;

double product(const Column& a, const Column& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Zeros where the values differ by their rounding alone.
Column centred(Column values) {
  constexpr double kRounding = 1e-12;
  double mean = 0.0;
  double largest = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) largest = std::max(largest, std::abs(value - mean));
  const bool is_constant = largest <= kRounding * std::abs(mean);
  for (double& value : values) value = is_constant ? 0.0 : value - mean;
  return values;
}

Column column_of(const std::vector<Pair>& pairs, double Pair::*member) {
  Column column;
  for (const Pair& pair : pairs) column.push_back(pair.*member);
  return centred(std::move(column));
}

/// Less its straight line over `time` (centred).
Column without_trend(Column values, const Column& time) {
  const double slope = product(values, time) / product(time, time);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] -= slope * time[i];
  return values;
}

/// Two-sided, of a correlation r with this many degrees of freedom; no number where r is none.
double chance_of(double r, double freedom) {
  if (std::isnan(r)) return r;
  return t_chance(r * std::sqrt(freedom / std::max(1e-12, 1.0 - r * r)), freedom);
}

std::string seen(double p) {
  return fmt::format("{} at the {:g} % level (p {:.2g})", p < thresholds::kProven ? "proven" : "not proven",
                     100.0 * thresholds::kProven, p);
}

ShortTest test_drift(const std::vector<Pair>& pairs, double duration_s) {
  const Column time = column_of(pairs, &Pair::time_s);
  const Column period = column_of(pairs, &Pair::period_s);
  const auto count = static_cast<double>(pairs.size());
  double mean_s = 0.0;
  for (const Pair& pair : pairs) mean_s += pair.period_s / count;
  const double slope = product(period, time) / product(time, time);
  const double r = slope * std::sqrt(product(time, time) / product(period, period));
  const double change = slope * duration_s / mean_s;
  const double p = chance_of(r, count - 2.0);
  return {TestKind::PeriodDrift, change, std::abs(change) * std::sqrt((1.0 / (r * r) - 1.0) / (count - 2.0)), p,
          fmt::format("the period changes by {:+.3g} % from start to end: {}", 100.0 * change, seen(p))};
}

ShortTest test_return_map(const std::vector<Pair>& pairs) {
  const Column time = column_of(pairs, &Pair::time_s);
  const Column force = without_trend(column_of(pairs, &Pair::force), time);
  const Column before = without_trend(column_of(pairs, &Pair::force_before), time);
  const double r = product(force, before) / std::sqrt(product(force, force) * product(before, before));
  const double freedom = static_cast<double>(pairs.size()) - 3.0;
  const double p = chance_of(r, freedom);
  return {TestKind::ReturnMap, r, std::sqrt((1.0 - r * r) / freedom), p,
          fmt::format("the static friction of a slip correlates by {:+.2f} with that of the previous slip: {}", r,
                      seen(p))};
}

/// F_s = a + b ln(time in stick). A large F_s makes its own stick long, so that the plain slope means nothing; the slip
/// before decides how far the ramp has to rise and knows nothing of this F_s: it is the instrument.
ShortTest test_ageing(const std::vector<Pair>& pairs, const std::string& unit) {
  const Column time = column_of(pairs, &Pair::time_s);
  const Column force = without_trend(column_of(pairs, &Pair::force), time);
  const Column before = without_trend(column_of(pairs, &Pair::force_before), time);
  const Column stick = without_trend(column_of(pairs, &Pair::log_stick), time);
  const double slope = product(force, before) / product(stick, before);
  double square = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) square += std::pow(force[i] - slope * stick[i], 2);
  const double freedom = static_cast<double>(pairs.size()) - 3.0;
  const double se = std::sqrt(square / freedom * product(before, before)) / std::abs(product(stick, before));
  const double r = product(force, before) / std::sqrt(product(force, force) * product(before, before));
  const double p = chance_of(r, freedom);
  return {TestKind::Ageing, slope, se, p,
          fmt::format("static friction changes by {:+.2g} ± {:.1g} {} if the stick lasts 2.72 times as long: {}; this "
                      "uses the same correlation as the previous test",
                      slope, se, unit, seen(p))};
}

/// Returns the estimate, or nothing if it has no interval.
std::optional<Estimate> known_estimate(Estimate estimate) {
  if (!estimate.value || !estimate.ci95) return std::nullopt;
  return estimate;
}

ShortTest test_mass(const FitResult& fit, double stated_kg) {
  const std::optional<Estimate> mass = known_estimate(fit.estimate_of(ParameterId::Mass));
  if (!mass || !(*mass->standard_error > 0.0)) {
    return {TestKind::StatedMass, {}, {}, {}, "k/w_n^2 is unknown: the stated mass cannot be compared with it"};
  }
  const double ratio = *mass->value / stated_kg;
  const double relative_se = *mass->standard_error / *mass->value;
  const double p = 2.0 * normal_above(std::abs(std::log(ratio)) / relative_se);
  return {TestKind::StatedMass, ratio, ratio * relative_se, p,
          fmt::format("k/w_n^2 is {:.3g} ± {:.1g} times the stated mass, a difference {}", ratio, ratio * relative_se,
                      seen(p))};
}

ShortTest test_resonance(const FitResult& fit, double resonance_Hz) {
  const std::optional<Estimate> omega = known_estimate(fit.natural_frequency());
  if (!omega) return {TestKind::SensorResonance, {}, {}, {}, "w_n is not known"};
  const double ratio = *omega->value / (2.0 * std::numbers::pi * resonance_Hz);
  return {TestKind::SensorResonance,
          ratio,
          *omega->standard_error / *omega->value * ratio,
          {},
          fmt::format("the natural frequency of the slips is {:.2g} times the resonance of the load cell: {}", ratio,
                      ratio < thresholds::kNearResonance ? fmt::format("the sensor shows the slips {:.1g} % too large",
                                                                       100.0 * (1.0 / (1.0 - ratio * ratio) - 1.0))
                                                         : "k, w_n and zeta may be those of the load cell")};
}

/// Cycles alike to the last digit leave a test nothing to divide by: it is then not known.
ShortTest finite(ShortTest test) {
  for (const auto& number : {test.value, test.standard_error, test.p_value}) {
    if (!number || std::isfinite(*number)) continue;
    return {test.kind, {}, {}, {}, fmt::format("the cycles differ too little for the test {}", name_of(test.kind))};
  }
  return test;
}

}  // namespace

std::vector<ShortTest> run_short_tests(const Recording& recording, const Analysis& analysis) {
  std::vector<ShortTest> tests;
  if (analysis.motion != MotionClass::StickSlip) return tests;
  const Conditions& conditions = recording.conditions();
  const auto speed_m_per_s = conditions.speed_is_known ? std::optional(conditions.speed_m_per_s) : std::nullopt;
  if (auto repeats = test_level_repeats(analysis.cycle_table, speed_m_per_s)) tests.push_back(*repeats);
  if (!analysis.fit) return tests;
  const FitResult& fit = *analysis.fit;
  const std::vector<Pair> pairs = pairs_of(fit.cycles);
  const bool scatters =
      fit.diagnostics.onset_force_spread > thresholds::kClearSigmas * fit.diagnostics.onset_force_error;
  if (pairs.size() >= thresholds::kFewestPairs) tests.push_back(test_drift(pairs, recording.duration_s()));
  if (pairs.size() >= thresholds::kFewestPairs && scatters) {
    tests.push_back(test_return_map(pairs));
    tests.push_back(test_ageing(pairs, conditions.quantity == ForceQuantity::Force_N ? "N" : ""));
  }
  if (conditions.mass_kg && !fit.mass_gives_frequency) tests.push_back(test_mass(fit, *conditions.mass_kg));
  if (conditions.sensor_resonance_Hz) tests.push_back(test_resonance(fit, *conditions.sensor_resonance_Hz));
  for (ShortTest& test : tests) test = finite(std::move(test));
  return tests;
}

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
  return series.value - trend * signal::least_squares(trend, series.value);
}

Sine sine_in(const Series& series, double waves) {
  const Eigen::MatrixXd columns = signal::line_and_harmonics(series.place, {.frequency_Hz = waves});
  const Eigen::VectorXd fitted = signal::least_squares(columns, series.value);
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
                   fmt::format("the force level varies by {:.3g} % of the mean drop once every {:.3g} slips{}: {} at "
                               "the {:g} % level (p {:.2g}){}",
                               100.0 * swing, (count - 1.0) / best.waves, path, is_proven ? "proven" : "not proven",
                               100.0 * thresholds::kProven, p,
                               is_proven ? "; texture of the counterface repeats after the same displacement at every "
                                           "speed, a wave of the drive or the sensor after the same time"
                                         : "")};
}

}  // namespace slipfit
