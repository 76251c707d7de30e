#include "report/text_sections.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "analysis/rules.hpp"
#include "report/blocks.hpp"
#include "report/names.hpp"
#include "report/quantity_rows.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/report/sweep.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {

namespace {

/// Each note once, behind the names of the parameters that it is about.
std::string notes_text(const std::vector<Parameter>& parameters) {
  std::string text;
  for (auto first = parameters.begin(); first != parameters.end(); ++first) {
    const std::string& note = first->estimate.note;
    const auto has_note = [&note](const Parameter& parameter) { return parameter.estimate.note == note; };
    if (note.empty() || std::any_of(parameters.begin(), first, has_note)) continue;
    std::string names;
    for (auto other = first; other != parameters.end(); ++other) {
      if (has_note(*other)) names += (names.empty() ? "" : ", ") + printable(info(other->id).words);
    }
    const bool is_of_all = std::ranges::all_of(parameters, has_note);
    text += wrapped_text("    ", fmt::format("{}: {}", is_of_all ? "all of them" : names, printable(note)));
  }
  return text;
}

}  // namespace

std::vector<std::string> status_meanings(const std::vector<Parameter>& parameters) {
  constexpr auto kMeanings = std::to_array<std::pair<ParameterStatus, std::string_view>>(
      {{ParameterStatus::Weak, "an estimate that should be confirmed"},
       {ParameterStatus::Bounded, "only an interval is known"},
       {ParameterStatus::Unidentified, "the data do not determine it"},
       {ParameterStatus::Conditional, "determined if the assumption in its note holds"},
       {ParameterStatus::Fixed, "fixed at the stated value"}});
  std::vector<std::string> meanings;
  for (const auto& [status, meaning] : kMeanings) {
    if (std::ranges::find(parameters, status, &Parameter::status) == parameters.end()) continue;
    meanings.push_back(fmt::format("{}: {}", name_of(status), meaning));
  }
  return meanings;
}

std::string critical_speed_text(const Estimate& speed_m_per_s, const Estimate& lambda, const std::string& given_unit) {
  std::string text = fmt::format("  {}: ", quantity_with_key("critical_speed_m_per_s").words);
  const std::string& note = speed_m_per_s.note;
  if (!speed_m_per_s.value) return text + (note.empty() ? "not known" : printable(note)) + "\n";
  text += estimate_text(speed_m_per_s, speed_unit(given_unit, speed_m_per_s.value));
  if (!note.empty()) return text + "\n" + wrapped_text("  ", printable(note));
  return text + fmt::format(", lambda there {}\n", estimate_text(lambda, display_unit("", {})));
}

std::string off_by(const Estimate& predicted, const Estimate& measured) {
  if (!predicted.value || !measured.value) return "-";
  constexpr double kWorthAPercentage = 10.0;
  const double factor = std::exp(std::abs(std::log(*predicted.value / *measured.value)));
  if (!(factor < kWorthAPercentage)) return "more than a factor of 10";
  return fmt::format("{:+.1f} %", 100.0 * (*predicted.value / *measured.value - 1.0));
}

std::string conditions_text(const std::vector<std::string>& conditional_on) {
  if (conditional_on.empty()) return {};
  return wrapped_text("  assumed: ", printable(fmt::format("{}", fmt::join(conditional_on, "; "))));
}

EstimateRow parameter_row(const Parameter& parameter) {
  EstimateRow row = estimate_row(parameter.estimate, std::string(info(parameter.id).unit));
  const bool has_value =
      parameter.status != ParameterStatus::Bounded && parameter.status != ParameterStatus::Unidentified;
  if (!has_value) row.value = "-";
  return row;
}

std::vector<ShownParameter> shown_parameters(const FitResult& fit) {
  std::vector<ShownParameter> shown;
  for (const Parameter& parameter : fit.parameters) {
    EstimateRow row = parameter_row(parameter);
    if (row.interval.empty()) row.interval = "-";
    shown.push_back({printable(info(parameter.id).words), row, parameter.status, printable(parameter.estimate.note)});
  }
  return shown;
}

std::string parameters_text(const FitResult& fit, ForceQuantity quantity, const std::string& caution) {
  Table table({Align::Left, Align::Right, Align::Left, Align::Left, Align::Left});
  table.add({"", "value", "unit", "95 % interval", "status"});
  for (const ShownParameter& parameter : shown_parameters(fit)) {
    const EstimateRow& numbers = parameter.numbers;
    table.add({parameter.words, numbers.value, numbers.unit, numbers.interval, std::string(name_of(parameter.status))});
  }
  std::string text = fmt::format("\nParameters{}\n", caution) + table.text() + notes_text(fit.parameters);
  for (const std::string& meaning : status_meanings(fit.parameters)) text += "  " + meaning + "\n";
  return text + text_of(models_block(fit, quantity)) + text_of(correlations_block(fit));
}

std::string parameters_text(const Recording& recording, const Analysis& analysis) {
  if (!analysis.fit) return {};
  if (analysis.motion == MotionClass::SteadySliding) {
    return "\nParameters\n  none: the model describes stick-slip, which this recording does not show\n";
  }
  const bool is_doubtful = analysis.motion == MotionClass::Undetermined;
  return parameters_text(*analysis.fit, recording.conditions().quantity,
                         is_doubtful ? " (unreliable: the motion may not be stick-slip)" : "");
}

namespace {

std::string recordings_text(std::span<const SweepEntry> entries, const SweepAnalysis& sweep) {
  Table table({Align::Left, Align::Right, Align::Left, Align::Left, Align::Left, Align::Left, Align::Right});
  table.add({"recording", "speed", "shows", "kinetic friction", std::string(kMeasured.front().words),
             "predicted from the others", "off by"});
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const SweepPoint* point = sweep.fit ? &sweep.fit->points[i] : nullptr;
    const Estimate& measured = sweep.recordings[i].derived.pattern_spacing_m;
    table.add({printable(entries[i].id), speed_text(entries[i].recording.conditions()),
               fmt::format("{}{}", plain_words(name_of(sweep.recordings[i].motion)),
                           sweep.roles[i] == SweepRole::LeftOut ? " (left out)" : ""),
               point != nullptr ? with_error(point->kinetic_friction_N, "N") : "-", with_error(measured, "m"),
               point != nullptr ? estimate_text(point->spacing_left_out_m, "m") : "-",
               point != nullptr ? off_by(point->spacing_left_out_m, measured) : "-"});
  }
  return "\nRecordings\n" + table.text();
}

}  // namespace

std::string to_text(std::span<const SweepEntry> entries, const SweepAnalysis& sweep, const std::string& name) {
  std::string text = fmt::format("{}: {} recordings fitted together\n", printable(name), entries.size());
  if (!sweep.fit)
    text = fmt::format("{}: {} recordings, no joint fit: {}\n", printable(name), entries.size(), sweep.fit_reason);
  if (sweep.fit) text += parameters_text(sweep.fit->result, ForceQuantity::Force_N, "");
  text += recordings_text(entries, sweep) + text_of(repeats_block(sweep.repeats));
  if (sweep.fit || sweep.derived.observed_end) {
    text += "\nEnd of stick-slip\n" + critical_speed_text(sweep.derived.critical_speed_m_per_s,
                                                          sweep.derived.lambda_critical,
                                                          entries.front().recording.conditions().speed_unit);
  }
  return text + warnings_text(sweep.warnings);
}

std::string warnings_text(const Warnings& warnings) {
  std::string doubts;
  std::string facts;
  for (const Warning& warning : warnings) {
    (is_fact(warning) ? facts : doubts) +=
        wrapped_text(is_fact(warning) ? "  - " : "  ! ", printable(warning.message + " [" + warning.code + "]"));
  }
  return (doubts.empty() ? "" : "\nWarnings\n" + doubts) +
         (facts.empty() ? "" : "\nAccounted for in the analysis\n" + facts);
}

std::string assumed_text(const std::vector<std::string>& assumed) {
  if (assumed.empty()) return {};
  std::string text = "\nAssumed while reading\n";
  for (const std::string& sentence : assumed) text += wrapped_text("  - ", printable(sentence));
  return text;
}

std::string to_text(const Recording& recording, const Analysis& analysis) {
  std::string text = headline_of(recording, analysis) + "\n";
  if (!analysis.motion_reason.empty()) text += wrapped_text("  ", printable(analysis.motion_reason));
  text += parameters_text(recording, analysis) + text_of(coefficients_block(analysis.coefficients));
  for (const Block& block : number_blocks(recording, analysis)) text += text_of(block);
  return text + text_of(quality_block(recording, analysis)) + warnings_text(analysis.warnings) +
         assumed_text(recording.provenance().assumed);
}

}  // namespace slipfit
