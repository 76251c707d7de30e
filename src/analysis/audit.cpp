#include "analysis/audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "core/unknown.hpp"

namespace slipfit {
namespace {

using Id = ParameterId;

/// A recording, and the fit whose parameters are audited: its own, or one of several recordings.
struct Subject {
  const Recording& recording;
  const Analysis& analysis;
  const FitResult& fit;

  [[nodiscard]] double speed_m_per_s() const { return recording.conditions().speed_m_per_s; }
  /// A parameter proportional to this power of k, at the speed of the recording.
  [[nodiscard]] Estimate parameter(Id id, double power) const;
};

Estimate Subject::parameter(Id id, double power) const {
  Estimate estimate = fit.estimate_of(id);
  if (!estimate.value || !fit.estimate || !fit.estimate->stiffness_trend) return estimate;
  const StiffnessTrend& trend = *fit.estimate->stiffness_trend;
  const double growth = std::exp(power * trend.log_growth_at(speed_m_per_s()));
  const double exponent_error = fit.estimate_of(Id::StiffnessExponent).standard_error.value_or(0.0);
  const double of_trend = power * exponent_error * std::log(speed_m_per_s() / trend.speed_m_per_s);
  estimate = scaled(std::move(estimate), growth);
  if (estimate.standard_error) {
    estimate.standard_error = std::hypot(*estimate.standard_error, *estimate.value * of_trend);
  }
  return estimate;
}

/// A parameter is proportional to this power of the audited quantity.
struct Concern {
  Id id{};
  double power = 1.0;
};

constexpr std::array kOfStiffness{Concern{Id::Stiffness}, Concern{Id::Mass}, Concern{Id::DampingCoefficient}};
/// The data give k V.
constexpr std::array kOfSpeed{Concern{Id::Stiffness, -1.0}, Concern{Id::Mass, -1.0},
                              Concern{Id::DampingCoefficient, -1.0}};
constexpr std::array kOfMass{Concern{Id::Mass}, Concern{Id::NaturalFrequency, -0.5}};

/// Returns true if the middle three fifths of the rises are stick: from trough to stick, and from stick to peak, a slip
/// takes up to atan(1 / lambda) / w_n, a quarter of its time at lambda = 1.
bool has_long_sticks(const CycleStatistics& cycles) {
  if (!cycles.slip_time_s) return true;  // not resolved: a jump
  return cycles.stick_time_s && 0.2 * *cycles.stick_time_s > 0.25 * *cycles.slip_time_s;
}

/// Slope of the sticks over V without the drift in it, with an error by lines, whose phase is alike in all sticks where
/// these are taken from the lowest to the highest force. Empty where the model's sticks are not straight, and of a
/// contact sensor, whose fit states no drift.
Estimate stiffness_by_sticks(const Subject& of) {
  const FitResult& fit = *of.analysis.fit;
  Estimate slope = of.analysis.cycles.stick_stiffness;
  if (!slope.value || !slope.standard_error || !has_long_sticks(of.analysis.cycles)) return {};
  if (of.fit.find(Id::Relaxation) != nullptr || fit.find(Id::ReloadLength) != nullptr ||
      of.fit.find(Id::ReloadLength) != nullptr || of.recording.conditions().force_view == ForceView::Contact)
    return {};
  *slope.value -= fit.level_trend.in_sticks_per_s / of.speed_m_per_s();
  const double by_lines = fit.diagnostics.stick_slope_by_lines / of.speed_m_per_s();
  *slope.standard_error = std::hypot(*slope.standard_error, by_lines / kNormalQuantile);
  slope.ci95.reset();
  return slope;
}

/// The slope of the sticks that the fit leaves out or averages with the rest, because it differs from that of most.
Estimate stiffness_by_other_sticks(const Subject& of) {
  const bool is_comparable = stiffness_by_sticks(of).value.has_value();
  return is_comparable ? of.analysis.cycles.other_sticks.stiffness : Estimate{};
}

Estimate stated_speed(const Subject& of) {
  const double error = of.recording.conditions().speed_standard_error_m_per_s.value_or(0.0);
  return {of.speed_m_per_s(), error, std::nullopt, {}};
}

Estimate speed_of_displacement(const Subject& of) {
  if (of.analysis.drive) return {};  // the fit does not use the stated speed
  return of.recording.provenance().moved_m_per_s.value_or(Estimate{});
}

/// Drop over stick time and V, over w_n^2: the secant of the whole stick, whatever bends in it. Noise raises the
/// highest sample and lowers the lowest one: the drop is too large by about twice the noise, which are two of its
/// standard errors here.
Estimate mass_by_secant(const Subject& of) {
  const CycleStatistics& cycles = of.analysis.cycles;
  const Estimate omega = of.parameter(Id::NaturalFrequency, 0.5);
  const Estimate slope = cycles.stick_stiffness;
  if (!omega.value || !omega.standard_error || !slope.value || !slope.standard_error || !cycles.force_drop ||
      !cycles.stick_time_s || !has_long_sticks(cycles)) {
    return {};
  }
  const double speed_m_per_s = of.analysis.drive ? of.analysis.drive->stick_speed_m_per_s : of.speed_m_per_s();
  const double secant = *cycles.force_drop / (*cycles.stick_time_s * speed_m_per_s);
  const double mass = secant / (*omega.value * *omega.value);
  const double of_slope = *slope.standard_error / *slope.value;
  const double of_omega = 2.0 * *omega.standard_error / *omega.value;
  const double relative = std::hypot(of_slope, of_omega, of.analysis.quality.noise_rms / *cycles.force_drop);
  return {mass, mass * relative, std::nullopt, {}};
}

Estimate stated_mass(const Subject& of) {
  const Conditions& conditions = of.recording.conditions();
  if (!conditions.mass_kg || of.fit.mass_gives_frequency) return {};
  const double error_kg = conditions.mass_standard_error_kg.value_or(thresholds::kUsualMassError * *conditions.mass_kg);
  return {*conditions.mass_kg, error_kg, std::nullopt, {}};
}

/// Returns the spectral frequency, or nothing if the line is neither that of the slips nor one of their harmonics.
Estimate frequency_by_spectrum(const Subject& of) {
  const FrequencyReport& report = of.analysis.frequency;
  const SpectralFrequency& spectral = report.spectral;
  const auto is_it = [&](const SuspiciousLine& line) { return line.frequency_Hz == spectral.value_Hz; };
  if (!spectral.value_Hz || !report.quoted.value) return {};
  if (std::any_of(report.lines.begin(), report.lines.end(), is_it)) return {};
  if (std::lround(*spectral.value_Hz / *report.quoted.value) != 1) return {};
  return {spectral.value_Hz, spectral.standard_error_Hz, std::nullopt, {}};
}

Estimate stiffness(const Subject& of) {
  return of.parameter(Id::Stiffness, 1.0);
}
Estimate quoted(const Subject& of) {
  return of.analysis.frequency.quoted;
}
Estimate counted_frequency(const Subject& of) {
  return of.analysis.frequency.counted;
}

/// One of two quantities that are the same: its place in the document, its name in a sentence, and its source.
struct Side {
  std::string_view place, words;
  Estimate (*estimate)(const Subject&);
};

constexpr Side kStiffness{"parameters.stiffness_N_per_m", "the stiffness k of the fit", stiffness};
constexpr Side kQuoted{"frequency.value_Hz", "the quoted frequency", quoted};

/// A pair of them, and the parameters that a contradiction puts in question (none: the quoted frequency).
struct Row {
  std::string_view pair;
  Side first, second;
  std::string_view unit;
  std::span<const Concern> concerns;
  ParameterStatus highest = ParameterStatus::Weak;
  double spacing_power = 0.0;  ///< the measured spacing is proportional to this power of the audited quantity
};

constexpr std::array kRows = std::to_array<Row>({
    {"stiffness_and_sticks",
     kStiffness,
     {"cycles.stick_stiffness_N_per_m", "the slope of the sticks over the speed", stiffness_by_sticks},
     "N/m",
     kOfStiffness},
    {"stiffness_and_other_sticks",
     kStiffness,
     {"slope of the sticks that differ, over the speed", "the slope of other sticks over the speed",
      stiffness_by_other_sticks},
     "N/m",
     kOfStiffness},
    {"speed_and_displacement",
     {"recording.speed_m_per_s", "the stated speed", stated_speed},
     {"speed of the displacement column", "the speed of the displacement column", speed_of_displacement},
     "m/s",
     kOfSpeed,
     ParameterStatus::Conditional,
     1.0},
    {"mass_and_stated_mass",
     {"secant of the sticks / w_n^2", "the mass by the secant of the sticks over w_n^2", mass_by_secant},
     {"recording.mass_kg", "the stated mass", stated_mass},
     "kg",
     kOfMass},
    {"frequency_and_count", kQuoted, {"frequency.counted", "the frequency by counting", counted_frequency}, "Hz", {}},
    {"frequency_and_spectrum",
     kQuoted,
     {"frequency.spectral", "the frequency of the spectrum", frequency_by_spectrum},
     "Hz",
     {}},
});

const Row& row_of(const AuditPair& pair) {
  return *std::find_if(kRows.begin(), kRows.end(), [&](const Row& row) { return row.pair == pair.pair; });
}

bool has_error(const Estimate& estimate) {
  return estimate.value && (estimate.standard_error || estimate.ci95);
}

/// Standard error on the side of another value: an interval may be longer there.
double error_towards(const Estimate& estimate, double other) {
  if (!estimate.ci95) return *estimate.standard_error;
  return std::max(reach_towards(estimate, other) / kNormalQuantile, 0.0);
}

bool contradict(const Estimate& first, const Estimate& second) {
  const double difference = std::abs(*first.value - *second.value);
  const double error = std::hypot(error_towards(first, *second.value), error_towards(second, *first.value));
  return difference > thresholds::kSureSigmas * error &&
         difference > thresholds::kNegligible * std::min(std::abs(*first.value), std::abs(*second.value));
}

/// Lets the interval reach the same multiple of the value; nothing where there is none.
void include(Estimate& estimate, double factor) {
  if (!estimate.value) return;
  const double value = factor * *estimate.value;
  estimate = including(std::move(estimate), value);
}

/// Never a higher status.
void lower(Parameter& parameter, ParameterStatus highest) {
  const bool is_higher = parameter.status == ParameterStatus::Identified ||
                         (parameter.status == ParameterStatus::Conditional && highest == ParameterStatus::Weak);
  if (is_higher) parameter.status = highest;
}

/// Returns the pair of this row that contradicts itself with the largest difference, or null if no pair does.
const AuditPair* worst_of(const Row& row, const std::vector<AuditPair>& pairs) {
  const AuditPair* worst = nullptr;
  double greatest = 0.0;
  for (const AuditPair& pair : pairs) {
    if (pair.pair != row.pair || !pair.contradicts) continue;
    const double ratio = *pair.second.value / *pair.first.value;
    const double distance = ratio > 0.0 ? std::abs(std::log(ratio)) : std::numeric_limits<double>::infinity();
    if (distance < greatest) continue;
    greatest = distance;
    worst = &pair;
  }
  return worst;
}

/// Returns true if the value itself is in question; if most recordings of a joint fit agree with the shared value, the
/// others are in question, but its status is lowered all the same.
bool is_in_question(const Row& row, const std::vector<AuditPair>& pairs) {
  const auto is_compared = [&](const AuditPair& pair) { return pair.pair == row.pair; };
  const auto contradicts = [&](const AuditPair& pair) { return is_compared(pair) && pair.contradicts; };
  return 2 * std::ranges::count_if(pairs, contradicts) >= std::ranges::count_if(pairs, is_compared);
}

/// The model's covariance with the way to the other value.
void widen(ModelEstimate& model, std::span<const Concern> concerns, double log_ratio) {
  std::array<double, kModelValues> move{};
  for (const Concern& concern : concerns) {
    const std::size_t place = place_in_model(concern.id);
    if (place < kModelValues) move[place] = concern.power * log_ratio / kNormalQuantile;
  }
  for (std::size_t i = 0; i < kModelValues; ++i) {
    for (std::size_t j = 0; j < kModelValues; ++j) model.covariance[i][j] += move[i] * move[j];
  }
}

}  // namespace

std::string sentence_of(const AuditPair& pair) {
  const std::string place = pair.recording.empty() ? "" : fmt::format("recording '{}': ", pair.recording);
  const Row& row = row_of(pair);
  return fmt::format("{}{} is {:.4g} {}, {} is {:.4g} {}", place, row.first.words, *pair.first.value, row.unit,
                     row.second.words, *pair.second.value, row.unit);
}

std::vector<AuditPair> audit_of(const Recording& recording, const Analysis& analysis, const FitResult& fit) {
  std::vector<AuditPair> pairs;
  if (analysis.motion != MotionClass::StickSlip || !analysis.fit) return pairs;
  const Subject subject{recording, analysis, fit};
  for (const Row& row : kRows) {
    AuditPair pair{std::string(row.pair), std::string(row.first.place), std::string(row.second.place),
                   row.first.estimate(subject), row.second.estimate(subject)};
    if (!has_error(pair.first) || !has_error(pair.second)) continue;
    pair.contradicts = contradict(pair.first, pair.second);
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

std::vector<AuditPair> joint_audit_of(const SweepEntry& entry, const Analysis& analysis, const FitResult& joint) {
  std::vector<AuditPair> pairs = audit_of(entry.recording, analysis, joint);
  for (AuditPair& pair : pairs) {
    if (row_of(pair).concerns.empty()) {  // the recording's own, whose quoted frequency includes both values already
      pair = *std::ranges::find(analysis.audit, pair.pair, &AuditPair::pair);
    }
    pair.recording = entry.id;
  }
  return pairs;
}

FitResult with_audit(FitResult fit, const std::vector<AuditPair>& pairs) {
  for (const Row& row : kRows) {
    const AuditPair* const pair = worst_of(row, pairs);
    if (pair == nullptr) continue;
    const double ratio = *pair->second.value / *pair->first.value;
    const bool is_widened = ratio > 0.0 && is_in_question(row, pairs);
    for (const Concern& concern : row.concerns) {
      for (Parameter& parameter : fit.parameters) {
        if (parameter.id != concern.id || parameter.status == ParameterStatus::Fixed) continue;
        lower(parameter, row.highest);
        if (is_widened) include(parameter.estimate, std::pow(ratio, concern.power));
        add_note(parameter.estimate.note, "contradicted: " + sentence_of(*pair));
      }
    }
    if (fit.estimate && is_widened) widen(*fit.estimate, row.concerns, std::log(ratio));
  }
  return fit;
}

Derived with_audit(Derived derived, const std::vector<AuditPair>& pairs) {
  for (const AuditPair& pair : pairs) {
    const double power = row_of(pair).spacing_power;
    if (!pair.contradicts || power == 0.0) continue;
    const double factor = std::pow(*pair.second.value / *pair.first.value, power);
    include(derived.pattern_spacing_m, factor);
    include(derived.impulse_rate_per_m, 1.0 / factor);
  }
  return derived;
}

FrequencyReport with_audit(FrequencyReport frequency, const std::vector<AuditPair>& pairs) {
  for (const AuditPair& pair : pairs) {
    if (pair.contradicts && row_of(pair).concerns.empty())
      include(frequency.quoted, *pair.second.value / *pair.first.value);
  }
  return frequency;
}

Warnings warn_of(const std::vector<AuditPair>& pairs) {
  Warnings warnings;
  for (const AuditPair& pair : pairs) {
    const bool is_shared = pair.recording.empty() || !row_of(pair).concerns.empty();
    if (!pair.contradicts || !is_shared) continue;  // a recording of a joint fit has its own warning of its frequency
    const char* const what = is_in_question(row_of(pair), pairs)
                                 ? ": the intervals include both"
                                 : ": most of the other recordings agree with the shared value, check this one";
    warnings.push_back({"values_contradict", sentence_of(pair) + what});
  }
  return warnings;
}

}  // namespace slipfit
