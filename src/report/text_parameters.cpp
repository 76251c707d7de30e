#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "report/names.hpp"
#include "report/rounding.hpp"
#include "report/table.hpp"
#include "report/text_sections.hpp"
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
      if (has_note(*other)) names += (names.empty() ? "" : ", ") + one_line(info(other->id).words);
    }
    text += fmt::format("    {}: {}\n", names, one_line(note));
  }
  return text;
}

std::string residual_text(const FitResult& fit, ForceQuantity quantity) {
  std::string text = fmt::format("  fit: {} model, residual {} rms", name_of(fit.tier),
                                 quantity_text(fit.residual.rms, force_unit(quantity)));
  if (fit.residual.reduced_chi2) text += fmt::format(", reduced chi2 {:.3g}", *fit.residual.reduced_chi2);
  if (fit.residual.whiteness_p) text += fmt::format(", whiteness p {:.2g}", *fit.residual.whiteness_p);
  return text + "\n";
}

std::string candidates_text(const FitResult& fit, ForceQuantity quantity) {
  std::string text;
  for (const Candidate& candidate : fit.candidates) {
    text += fmt::format("    {} {}", candidate.chosen ? "taken:" : "left: ", name_of(candidate.tier));
    if (candidate.rms) text += fmt::format(", {} rms", quantity_text(candidate.rms, force_unit(quantity)));
    if (!candidate.reason.empty()) text += fmt::format(" ({})", one_line(candidate.reason));
    text += "\n";
  }
  return text;
}

}  // namespace

std::string conditions_text(const std::vector<std::string>& conditional_on) {
  if (conditional_on.empty()) return {};
  std::string text = "  holds if: ";
  for (std::size_t i = 0; i < conditional_on.size(); ++i) {
    text += (i == 0 ? "" : "; ") + one_line(conditional_on[i]);
  }
  return text + "\n";
}

std::vector<ShownParameter> shown_parameters(const FitResult& fit) {
  std::vector<ShownParameter> shown;
  for (const Parameter& parameter : fit.parameters) {
    const ParameterInfo& name = info(parameter.id);
    EstimateRow row = estimate_row(parameter.estimate, std::string(name.unit));
    const bool has_value =
        parameter.status != ParameterStatus::Bounded && parameter.status != ParameterStatus::Unidentified;
    if (!has_value) row.value = "-";
    shown.push_back(
        {one_line(name.words), row, std::string(name_of(parameter.status)), one_line(parameter.estimate.note)});
  }
  return shown;
}

std::string parameters_text(const FitResult& fit, ForceQuantity quantity, const std::string& caution) {
  Table table({Align::Left, Align::Right, Align::Left, Align::Left, Align::Left});
  table.add({"", "value", "unit", "95 % interval", "status"});
  for (const ShownParameter& parameter : shown_parameters(fit)) {
    const EstimateRow& numbers = parameter.numbers;
    table.add({parameter.words, numbers.value, numbers.unit, numbers.interval, parameter.status});
  }
  return fmt::format("\nParameters{}\n", caution) + table.text() + notes_text(fit.parameters) +
         residual_text(fit, quantity) + candidates_text(fit, quantity) + conditions_text(fit.conditional_on);
}

std::string parameters_text(const Recording& recording, const Analysis& analysis) {
  if (!analysis.fit) return {};
  if (analysis.verdict == Verdict::SteadySliding) {
    return "\nParameters\n  none: the model describes stick-slip, and this recording shows none\n";
  }
  const bool is_doubtful = analysis.verdict == Verdict::Undetermined;
  return parameters_text(*analysis.fit, recording.conditions().quantity,
                         is_doubtful ? " (not to rely on: this may be no stick-slip)" : "");
}

}  // namespace slipfit
