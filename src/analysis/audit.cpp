#include "analysis/audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/fit_thresholds.hpp"
#include "core/quantile.hpp"
#include "core/student.hpp"

namespace slipfit {
namespace {

using Id = ParameterId;

struct Subject {
  const Recording& recording;
  const Analysis& analysis;

  [[nodiscard]] Estimate parameter(Id id) const { return analysis.fit->estimate_of(id); }
};

/// A parameter goes as this power of the audited quantity.
struct Concern {
  Id id{};
  double power = 1.0;
};

constexpr std::array kOfStiffness{Concern{Id::Stiffness}, Concern{Id::Mass}, Concern{Id::DampingCoefficient}};
constexpr std::array kOfMass{Concern{Id::Mass}, Concern{Id::NaturalFrequency, -0.5}};
constexpr std::array kOfDrop{Concern{Id::FrictionDifference}};

Estimate shifted(Estimate estimate, double by) {
  if (estimate.value) *estimate.value += by;
  if (estimate.ci95) estimate.ci95 = Interval{estimate.ci95->low + by, estimate.ci95->high + by};
  return estimate;
}

/// The mean slope of the rise after a slip over the middle three fifths of a stick, over the speed.
double reload_slope_N_per_m(const Subject& of) {
  const std::optional<double> force = of.parameter(Id::ReloadForce).value;
  const std::optional<double> length = of.parameter(Id::ReloadLength).value;
  const std::optional<double>& stick_s = of.analysis.cycles.stick_time_s;
  if (!force || !length || !stick_s || !(*length > 0.0) || !(*stick_s > 0.0)) return 0.0;
  const double path_m = *stick_s * of.recording.conditions().speed_m_per_s;
  const double rise_N = *force * (std::exp(-0.2 * path_m / *length) - std::exp(-0.8 * path_m / *length));
  return rise_N / (0.6 * path_m);
}

/// Slope of the sticks over V without the drift and the rise after a slip that the fit has.
Estimate stiffness_by_sticks(const Subject& of) {
  const double drift = of.analysis.fit->level_trend.in_sticks_per_s / of.recording.conditions().speed_m_per_s;
  Estimate slope = shifted(of.analysis.cycles.stick_stiffness, -drift - reload_slope_N_per_m(of));
  // Slips may come at one phase of a line: its slope is then in every stick.
  const double by_lines = of.analysis.fit->diagnostics.stick_slope_by_lines / of.recording.conditions().speed_m_per_s;
  if (!slope.standard_error || !(by_lines > 0.0)) return slope;
  slope.standard_error = std::hypot(*slope.standard_error, by_lines);
  slope.ci95 = std::nullopt;
  return slope;
}

/// k V is what the data give: at the speed of the displacement k is another one.
Estimate stiffness_by_displacement(const Subject& of) {
  const std::optional<Estimate>& moved = of.recording.provenance().moved_m_per_s;
  const Estimate k = of.parameter(Id::Stiffness);
  if (!moved || !k.value) return {};
  const double value = *k.value * of.recording.conditions().speed_m_per_s / *moved->value;
  return {value, value * *moved->standard_error / *moved->value, std::nullopt, {}};
}

/// Drop over time in stick and V, over w_n^2: the secant of the whole stick, whatever bends in it.
Estimate mass_by_secant(const Subject& of) {
  const CycleStatistics& cycles = of.analysis.cycles;
  const Estimate omega = of.parameter(Id::NaturalFrequency);
  const Estimate slope = cycles.stick_stiffness;
  if (!omega.value || !omega.standard_error || !slope.value || !slope.standard_error || !cycles.force_drop ||
      !cycles.stick_time_s || !(*cycles.stick_time_s > 0.0)) {
    return {};
  }
  const double secant = *cycles.force_drop / (*cycles.stick_time_s * of.recording.conditions().speed_m_per_s);
  const double mass = secant / (*omega.value * *omega.value);
  const double relative = std::hypot(*slope.standard_error / *slope.value, 2.0 * *omega.standard_error / *omega.value);
  return {mass, mass * relative, std::nullopt, {}};
}

Estimate stated_mass(const Subject& of) {
  const Conditions& conditions = of.recording.conditions();
  if (!conditions.mass_kg || of.analysis.fit->mass_gives_frequency) return {};
  constexpr double kUnstatedError = 0.02;  // Conditions::mass_standard_error_kg
  return {*conditions.mass_kg,
          conditions.mass_standard_error_kg.value_or(kUnstatedError * *conditions.mass_kg),
          std::nullopt,
          {}};
}

/// Empty where the spectrum's line is not that of the slips, or a harmonic of it.
Estimate frequency_by_spectrum(const Subject& of) {
  const FrequencyReport& report = of.analysis.frequency;
  const SpectralFrequency& spectral = report.spectral;
  const auto is_it = [&](const SuspiciousLine& line) { return line.frequency_Hz == spectral.value_Hz; };
  if (!spectral.value_Hz || !report.quoted.value) return {};
  if (std::any_of(report.lines.begin(), report.lines.end(), is_it)) return {};
  if (std::lround(*spectral.value_Hz / *report.quoted.value) != 1) return {};
  return {spectral.value_Hz, spectral.standard_error_Hz, std::nullopt, {}};
}

/// A pair of quantities that are the same: where each is in the document, and which parameters a contradiction concerns
/// (none: the quoted frequency). `first` is what the document reports.
struct Row {
  std::string_view pair, first_of, second_of;
  std::span<const Concern> concerns;
  Estimate (*first)(const Subject&);
  Estimate (*second)(const Subject&);
  ParameterStatus highest = ParameterStatus::Weak;
};

constexpr std::array kRows = std::to_array<Row>({
    {"stiffness_and_sticks", "parameters.stiffness_N_per_m", "cycles.stick_stiffness_N_per_m", kOfStiffness,
     [](const Subject& of) { return of.parameter(Id::Stiffness); }, stiffness_by_sticks},
    {"stiffness_by_displacement", "parameters.stiffness_N_per_m", "parameters.stiffness_N_per_m by displacement",
     kOfStiffness, [](const Subject& of) { return of.parameter(Id::Stiffness); }, stiffness_by_displacement,
     ParameterStatus::Conditional},
    {"mass_and_stated_mass", "secant of the sticks / w_n^2", "recording.mass_kg", kOfMass, mass_by_secant, stated_mass},
    {"spacing_and_model", "derived.periodic_displacement_m", "derived.pattern_spacing_m", kOfDrop,
     [](const Subject& of) { return of.analysis.derived.periodic_displacement_m; },
     [](const Subject& of) { return of.analysis.derived.pattern_spacing_m; }},
    {"frequency_and_count",
     "frequency.value_Hz",
     "frequency.counted",
     {},
     [](const Subject& of) { return of.analysis.frequency.quoted; },
     [](const Subject& of) { return of.analysis.frequency.counted; }},
    {"frequency_and_spectrum",
     "frequency.value_Hz",
     "frequency.spectral",
     {},
     [](const Subject& of) { return of.analysis.frequency.quoted; },
     frequency_by_spectrum},
});

const Row& row_of(const AuditPair& pair) {
  return *std::find_if(kRows.begin(), kRows.end(), [&](const Row& row) { return row.pair == pair.pair; });
}

/// Standard error on the side of another value: an interval may be longer there.
double error_towards(const Estimate& estimate, double other) {
  const double se = estimate.standard_error.value_or(0.0);
  if (!estimate.ci95) return se;
  const double reach =
      other > *estimate.value ? estimate.ci95->high - *estimate.value : *estimate.value - estimate.ci95->low;
  return std::max(reach / kNormalQuantile, 0.0);
}

bool contradicts(const Estimate& first, const Estimate& second) {
  const double difference = std::abs(*first.value - *second.value);
  const double error = std::hypot(error_towards(first, *second.value), error_towards(second, *first.value));
  return difference > thresholds::kAuditSigmas * error &&
         difference > thresholds::kAuditShare * std::min(std::abs(*first.value), std::abs(*second.value));
}

bool has_error(const Estimate& estimate) {
  return estimate.value && (estimate.standard_error || estimate.ci95);
}

void include(Estimate& estimate, double value) {
  if (!estimate.value) return;
  const Interval ci95 = estimate.ci95.value_or(Interval{*estimate.value, *estimate.value});
  estimate.ci95 = Interval{std::min(ci95.low, value), std::max(ci95.high, value)};
  const double reach = std::max(estimate.ci95->high - *estimate.value, *estimate.value - estimate.ci95->low);
  estimate.standard_error = std::max(estimate.standard_error.value_or(0.0), reach / kNormalQuantile);
}

void lower(Parameter& parameter, ParameterStatus highest) {
  const bool is_higher = parameter.status == ParameterStatus::Identified ||
                         (parameter.status == ParameterStatus::Conditional && highest == ParameterStatus::Weak);
  if (is_higher) parameter.status = highest;
}

std::string sentence_of(const AuditPair& pair) {
  return fmt::format("{} is {:.4g}, {} says {:.4g}", pair.first_of, *pair.first.value, pair.second_of,
                     *pair.second.value);
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

std::vector<AuditPair> audit_of(const Recording& recording, const Analysis& analysis) {
  std::vector<AuditPair> pairs;
  if (analysis.motion != MotionClass::StickSlip || !analysis.fit) return pairs;
  const Subject subject{recording, analysis};
  for (const Row& row : kRows) {
    AuditPair pair{std::string(row.pair), std::string(row.first_of), std::string(row.second_of), row.first(subject),
                   row.second(subject)};
    if (!has_error(pair.first) || !has_error(pair.second)) continue;
    pair.contradicts = contradicts(pair.first, pair.second);
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

std::vector<AuditPair> audit_of(std::span<const Recording* const> recordings, std::span<const Analysis* const> analyses,
                                const FitResult& joint) {
  const Estimate k = joint.stiffness();
  if (!k.value || joint.find(Id::StiffnessExponent) != nullptr) return {};
  std::vector<double> by_sticks;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    if (!analyses[i]->fit) continue;
    const Estimate one = stiffness_by_sticks({*recordings[i], *analyses[i]});
    if (one.value) by_sticks.push_back(*one.value);
  }
  if (by_sticks.size() < 3) return {};
  const MeanAndSpread mean = describe(by_sticks);
  const Row& row = kRows.front();
  AuditPair pair{std::string(row.pair), std::string(row.first_of), std::string(row.second_of), k,
                 symmetric(mean.mean, mean.sd / std::sqrt(mean.count), mean.count - 1.0)};
  pair.contradicts = contradicts(pair.first, pair.second);
  return {pair};
}

FitResult with_audit(FitResult fit, const std::vector<AuditPair>& pairs) {
  for (const AuditPair& pair : pairs) {
    if (!pair.contradicts) continue;
    const Row& row = row_of(pair);
    const double ratio = *pair.second.value / *pair.first.value;
    for (const Concern& concern : row.concerns) {
      for (Parameter& parameter : fit.parameters) {
        if (parameter.id != concern.id || parameter.status == ParameterStatus::Fixed) continue;
        lower(parameter, row.highest);
        if (ratio > 0.0 && parameter.estimate.value) {
          include(parameter.estimate, *parameter.estimate.value * std::pow(ratio, concern.power));
        }
        std::string& note = parameter.estimate.note;
        note += fmt::format("{}contradicted: {}", note.empty() ? "" : "; ", sentence_of(pair));
      }
    }
    if (fit.estimate && ratio > 0.0) widen(*fit.estimate, row.concerns, std::log(ratio));
  }
  return fit;
}

FrequencyReport with_audit(FrequencyReport frequency, const std::vector<AuditPair>& pairs) {
  for (const AuditPair& pair : pairs) {
    if (pair.contradicts && row_of(pair).concerns.empty()) include(frequency.quoted, *pair.second.value);
  }
  return frequency;
}

Warnings warn_of(const std::vector<AuditPair>& pairs) {
  Warnings warnings;
  for (const AuditPair& pair : pairs) {
    if (!pair.contradicts) continue;
    warnings.push_back({"values_contradict", sentence_of(pair) + ": the intervals include both"});
  }
  return warnings;
}

}  // namespace slipfit
