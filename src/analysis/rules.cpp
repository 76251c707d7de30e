#include "analysis/rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/audit.hpp"
#include "analysis/conclusions.hpp"
#include "analysis/detect.hpp"
#include "core/thresholds.hpp"
#include "core/unknown.hpp"

namespace slipfit {
namespace {

using Messages = std::vector<std::string>;

/// A warning changes what a reader may conclude. A fact needs no action: a defect that was left out, or a term of the
/// model whose uncertainty the intervals include.
enum class RuleKind { Warning, Fact };

/// One code of a warning.
struct Rule {
  std::string_view code;
  RuleKind kind = RuleKind::Warning;
  /// One message for each time that the condition holds. Null: the warning is made where its cause is found, by the
  /// reader, the fit, the sweep or the comparison.
  Messages (*messages)(const Facts&) = nullptr;
  std::span<const ParameterId> limited = {};  ///< parameters that are at most conditional with this warning
};

Messages one(std::optional<std::string> message) {
  return message ? Messages{*std::move(message)} : Messages{};
}

Messages when(bool holds, const std::string& message) {
  return holds ? Messages{message} : Messages{};
}

/// The finding of a short test that chance does not explain, with what follows from it.
Messages proven(const Facts& facts, TestKind kind, const char* consequence = "") {
  Messages messages;
  for (const ShortTest& test : facts.analysis.tests) {
    const bool is_proven = test.p_value && *test.p_value <= thresholds::kProven;
    if (test.kind == kind && is_proven) messages.push_back(test.finding + consequence);
  }
  return messages;
}

Messages sensor_too_slow(const Facts& facts) {
  const std::optional<double> lag_s = facts.detected.recording().conditions().sensor_lag_s();
  const std::optional<double>& period_s = facts.analysis.cycles.period_s;
  if (!lag_s || !period_s) return {};
  const double lags = *period_s / *lag_s;
  return when(lags <= thresholds::kLagsOfCycle,
              fmt::format("a cycle lasts only {:.2g} times the lag of the sensor: its response to one slip has "
                          "not decayed when the next begins",
                          lags));
}

Messages near_sensor_resonance(const Facts& facts) {
  for (const ShortTest& test : facts.analysis.tests) {
    const bool is_near = test.value && *test.value > thresholds::kNearResonance;
    if (test.kind == TestKind::SensorResonance && is_near) return {test.finding};
  }
  return {};
}

Messages contradictions(const Facts& facts) {
  Messages messages;
  for (const Warning& warning : warn_of(facts.analysis.audit)) messages.push_back(warning.message);
  return messages;
}

Messages suspicious_lines(const Facts& facts) {
  Messages messages;
  for (const SuspiciousLine& line : facts.analysis.frequency.lines)
    messages.push_back(fmt::format("line at {:.4g} Hz: {}", line.frequency_Hz, line.reason));
  return messages;
}

Messages part_of_recording(const Facts& facts) {
  const Recording& whole = *facts.detected.whole;
  const TimeSpan& sliding = facts.analysis.sliding;
  const double share = (sliding.end_s - sliding.begin_s) / whole.duration_s();
  return when(share < thresholds::kMostlySliding,
              fmt::format("the analysis uses {:.6g} to {:.6g} s, {:.0f} % of the recording, where the body slides",
                          sliding.begin_s, sliding.end_s, 100.0 * share));
}

Messages drive_measured(const Facts& facts) {
  const std::optional<MeasuredDrive>& drive = facts.analysis.drive;
  if (!drive) return {};
  return {
      fmt::format("the force was fitted against the measured position of the drive, which moves at {:.4g} m/s while "
                  "the body sticks; stated are {:.4g} m/s",
                  drive->stick_speed_m_per_s, facts.detected.recording().conditions().speed_m_per_s)};
}

Messages drive_moves_in_slips(const Facts& facts) {
  const std::optional<MeasuredDrive>& drive = facts.analysis.drive;
  if (!drive || drive->share_in_slips < thresholds::kDriveInSlip) return {};
  return {
      fmt::format("the drive catches up during a slip, by {:.0f} % of its force drop: natural frequency, mass, "
                  "damping and F_s - F_k are approximate",
                  100.0 * drive->share_in_slips)};
}

Messages repeated_values(const Facts& facts) {
  return when(facts.detected.repeats() > 1.0,
              fmt::format("each value is repeated {:.3g} times because the logger is faster than the converter; each "
                          "was used once, every {:.3g} s",
                          facts.detected.repeats(), facts.detected.recording().sample_interval_s()));
}

Messages quantised(const Facts& facts) {
  const std::optional<double>& step = facts.detected.whole_quality.quantisation_step;
  if (!step) return {};
  const bool newtons = facts.detected.recording().conditions().quantity == ForceQuantity::Force_N;
  return {fmt::format("the force is quantised in steps of {:.3g}{}", *step, newtons ? " N" : "")};
}

const Quality& quality_in(const Facts& facts) {
  return facts.detected.whole_quality;
}

bool sticks(const Facts& facts) {
  return facts.analysis.motion == MotionClass::StickSlip;
}

/// The data give k V: a wrong speed, or a wrong unit, is in k and in all that follows from it.
constexpr std::array kScaledBySpeed{ParameterId::Stiffness, ParameterId::StiffnessExponent, ParameterId::Mass,
                                    ParameterId::DampingCoefficient};

/// The slip gives these.
constexpr std::array kShownBySlips{ParameterId::NaturalFrequency, ParameterId::Mass, ParameterId::DampingRatio,
                                   ParameterId::DampingCoefficient, ParameterId::FrictionDifference};

/// The rules with the largest effect on the results come first, facts last.
constexpr auto kRules = std::to_array<Rule>({
    {"implausible_units", RuleKind::Warning,
     [](const Facts& f) { return one(implausible_units(f.detected.recording(), f.analysis)); }, kScaledBySpeed},
    {"speed_differs_from_displacement", RuleKind::Warning, nullptr, kScaledBySpeed},
    {"speed_differs", RuleKind::Warning, nullptr, kScaledBySpeed},
    {"sample_rate_differs", RuleKind::Warning, nullptr, kScaledBySpeed},
    {"normal_force_differs", RuleKind::Warning},
    {"frequency_differs_at_one_speed", RuleKind::Warning},
    {"frequency_does_not_follow_speed", RuleKind::Warning},
    {"recording_repeated", RuleKind::Warning},
    {"values_contradict", RuleKind::Warning, contradictions},
    {"mains_in_step", RuleKind::Warning},
    {"recordings_disagree", RuleKind::Warning},
    {"recording_disagrees", RuleKind::Warning},
    {"level_differs", RuleKind::Warning},
    {"static_friction_differs", RuleKind::Warning},
    {"changes_on_the_way", RuleKind::Warning,
     [](const Facts& f) { return sticks(f) ? one(change_on_the_way(f.slips)) : Messages{}; }},
    {"level_trend", RuleKind::Warning},
    {"model_misfit", RuleKind::Warning},
    {"slips_not_inertial", RuleKind::Warning},
    {"drive_moves_in_slips", RuleKind::Warning, drive_moves_in_slips, kShownBySlips},
    {"near_sensor_resonance", RuleKind::Warning, near_sensor_resonance},
    {"sensor_too_slow", RuleKind::Warning, sensor_too_slow},
    {"samples_averaged", RuleKind::Warning},
    {"drive_ripple", RuleKind::Warning},
    {"clocked", RuleKind::Warning,
     [](const Facts& f) {
       return when(
           f.analysis.cycles.regularity == Regularity::Clocked,
           fmt::format("the slips are synchronous with the drive (period {:.4g} ms), which determines frequency "
                       "and spacing: they do not apply to other speeds",
                       1e3 * f.detected.recording().conditions().drive_period_s.value_or(0.0)));
     }},
    {"ring_down_differs", RuleKind::Warning},
    {"mass_differs", RuleKind::Warning,
     [](const Facts& f) {
       return proven(
           f, TestKind::StatedMass,
           "; springs or parts may move with the body, the contact may be compliant, or the slips differ from "
           "the model; the fit does not use the stated mass");
     }},
    {"slips_not_resolved", RuleKind::Warning},
    {"period_drifts", RuleKind::Warning, [](const Facts& f) { return proven(f, TestKind::PeriodDrift); }},
    {"cycles_remember", RuleKind::Warning, [](const Facts& f) { return proven(f, TestKind::ReturnMap); }},
    {"broken_rhythm", RuleKind::Warning,
     [](const Facts& f) { return sticks(f) ? one(broken_rhythm(f.detected.recording(), f.slips)) : Messages{}; }},
    {"clipped", RuleKind::Warning,
     [](const Facts& f) {
       return when(quality_in(f).clipped_samples > 0,
                   fmt::format("the sensor saturates: {} samples were left out", quality_in(f).clipped_samples));
     }},
    {"normal_force_varies", RuleKind::Warning},
    {"zero_force_ignored", RuleKind::Warning},
    {"option_ignored", RuleKind::Warning},
    {"scatter_unknown", RuleKind::Warning},
    {"scatter_of_one_side", RuleKind::Warning},
    {"speeds_differ", RuleKind::Warning},
    {"loads_differ", RuleKind::Warning},
    {"zeros_differ", RuleKind::Warning},
    {"motions_differ", RuleKind::Warning},
    {"origin_not_known", RuleKind::Warning},
    {"rsm_differs", RuleKind::Warning},
    {"spacing_drifts", RuleKind::Warning},
    {"holes_bridged", RuleKind::Warning},
    {"rows_without_number", RuleKind::Fact},
    {"time_runs_backwards", RuleKind::Fact},
    {"repeated_time_stamps", RuleKind::Fact},
    {"several_steps", RuleKind::Fact},
    {"strokes_pooled", RuleKind::Fact},
    {"container_cut", RuleKind::Fact},
    {"drive_measured", RuleKind::Fact, drive_measured},
    {"part_of_recording", RuleKind::Fact, part_of_recording},
    {"gaps", RuleKind::Fact,
     [](const Facts& f) {
       return when(quality_in(f).gaps > 0 && f.detected.recording().provenance().strokes == 0,
                   fmt::format("{} {} in the clock, the longest {:.3g} s", quality_in(f).gaps,
                               quality_in(f).gaps == 1 ? "gap" : "gaps", quality_in(f).longest_gap_s));
     }},
    {"uneven_clock", RuleKind::Fact,
     [](const Facts& f) {
       return when(quality_in(f).clock_jitter > thresholds::kUnevenClock,
                   fmt::format("the sample interval varies by {:.0f} %", 100.0 * quality_in(f).clock_jitter));
     }},
    {"repeated_values", RuleKind::Fact, repeated_values},
    {"impulses", RuleKind::Fact,
     [](const Facts& f) {
       return when(quality_in(f).impulses > 0,
                   fmt::format("{} isolated {} left out", quality_in(f).impulses,
                               quality_in(f).impulses == 1 ? "impulse was" : "impulses were"));
     }},
    {"quantised", RuleKind::Fact, quantised},
    {"suspicious_line", RuleKind::Fact, suspicious_lines},
    {"level_repeats", RuleKind::Fact, [](const Facts& f) { return proven(f, TestKind::LevelRepeats); }},
    {"hum_fitted", RuleKind::Fact},
    {"part_of_cycles_fitted", RuleKind::Fact},
    {"stiffness_goes_with_speed", RuleKind::Fact},
    {"static_friction_ages", RuleKind::Fact},
});

std::size_t place_of(const Warning& warning) {
  const auto* const found = std::ranges::find(kRules, warning.code, &Rule::code);
  return static_cast<std::size_t>(found - kRules.begin());
}

}  // namespace

bool is_fact(const Warning& warning) {
  const std::size_t place = place_of(warning);
  return place < kRules.size() && kRules.at(place).kind == RuleKind::Fact;
}

Warnings by_effect(Warnings warnings) {
  std::ranges::stable_sort(warnings, {}, place_of);
  return warnings;
}

Warnings collect_warnings(const Facts& facts) {
  const Analysis& analysis = facts.analysis;
  Warnings warnings = facts.detected.recording().provenance().warnings;
  if (analysis.fit && analysis.motion != MotionClass::SteadySliding) {
    warnings.insert(warnings.end(), analysis.fit->warnings.begin(), analysis.fit->warnings.end());
  }
  // The speed in the sticks of a drive that gives way is not its mean speed.
  if (analysis.drive)
    std::erase_if(warnings, [](const Warning& w) { return w.code == "speed_differs_from_displacement"; });
  for (const Rule& rule : kRules) {
    if (rule.messages == nullptr) continue;
    for (std::string& message : rule.messages(facts)) warnings.push_back({std::string(rule.code), std::move(message)});
  }
  return by_effect(std::move(warnings));
}

FitResult limited_by(const Warnings& warnings, FitResult fit) {
  for (const Warning& warning : warnings) {
    const std::size_t place = place_of(warning);
    if (place == kRules.size()) continue;
    const std::span<const ParameterId> limited = kRules.at(place).limited;
    for (Parameter& parameter : fit.parameters) {
      const bool is_limited = std::ranges::find(limited, parameter.id) != limited.end();
      if (!is_limited || parameter.status != ParameterStatus::Identified) continue;
      parameter.status = ParameterStatus::Conditional;
      add_note(parameter.estimate.note, "see the warning " + warning.code);
    }
  }
  return fit;
}

}  // namespace slipfit
