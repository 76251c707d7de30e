#include "analysis/conclusions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/student.hpp"
#include "core/thresholds.hpp"
#include "report/names.hpp"

namespace slipfit {
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
          fmt::format("the period changes by {:+.2g} % from start to end: {}", 100.0 * change, seen(p))};
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
  const boost::math::normal_distribution<double> normal;
  const double p = 2.0 * boost::math::cdf(boost::math::complement(normal, std::abs(std::log(ratio)) / relative_se));
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

}  // namespace slipfit
