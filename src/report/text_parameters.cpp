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

struct ParameterName {
  std::string_view key;
  std::string_view words;
  std::string_view unit;
};

constexpr std::array<ParameterName, 18> kParameterNames{{
    {"stiffness_N_per_m", "tangential stiffness k", "N/m"},
    {"friction_difference_N", "static minus kinetic friction", "N"},
    {"ageing_N", "static friction's growth with ln stick time", "N"},
    {"static_friction_N", "static friction F_s", "N"},
    {"kinetic_friction_N", "kinetic friction F_k", "N"},
    {"natural_frequency_rad_per_s", "natural frequency w_n", "rad/s"},
    {"mass_kg", "effective mass m", "kg"},
    {"damping_ratio", "damping ratio zeta", ""},
    {"damping_coefficient_N_s_per_m", "damping coefficient c", "N s/m"},
    {"friction_slope_N_s_per_m", "slope of friction at rest f1 alpha", "N s/m"},
    {"alpha_s_per_m", "velocity dependence alpha", "s/m"},
    {"f0_N", "friction at high speed f0", "N"},
    {"f1_N", "velocity-dependent friction f1", "N"},
    {"mu0", "friction coefficient mu0", ""},
    {"mu1", "friction coefficient mu1", ""},
    {"friction_coefficient_difference", "static minus kinetic coefficient", ""},
    {"static_friction_coefficient", "static friction coefficient", ""},
    {"kinetic_friction_coefficient", "kinetic friction coefficient", ""},
}};

ParameterName words_for(const Parameter& parameter) {
  for (const ParameterName& name : kParameterNames) {
    if (name.key == parameter.name) return name;
  }
  return {parameter.name, parameter.name, ""};
}

/// Each note once, behind the names of the parameters that it is about.
std::string notes_text(const std::vector<Parameter>& parameters) {
  std::string text;
  for (auto first = parameters.begin(); first != parameters.end(); ++first) {
    const std::string& note = first->estimate.note;
    const auto has_note = [&note](const Parameter& parameter) { return parameter.estimate.note == note; };
    if (note.empty() || std::any_of(parameters.begin(), first, has_note)) continue;
    std::string names;
    for (auto other = first; other != parameters.end(); ++other) {
      if (has_note(*other)) names += (names.empty() ? "" : ", ") + one_line(words_for(*other).words);
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
    const ParameterName name = words_for(parameter);
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
