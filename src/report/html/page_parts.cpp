#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/rules.hpp"
#include "report/blocks.hpp"
#include "report/html/markup.hpp"
#include "report/html/page.hpp"
#include "report/html/scaling.hpp"
#include "report/names.hpp"
#include "report/quantities.hpp"
#include "report/text_sections.hpp"

namespace slipfit::html {
namespace {

std::string status_mark(std::string_view status) {
  return status.empty() ? "" : fmt::format(R"(<small><span class="status {0}">{0}</span></small>)", text(status));
}

/// A headline number: its value, interval and status. `unknown_text` replaces a value that is not known.
std::string key_number(std::string_view words, const EstimateRow& row, std::string_view status,
                       const std::string& unknown_text = "not known") {
  const std::string shown = row.value == "-" ? unknown_text : row.value + (row.unit.empty() ? "" : " " + row.unit);
  const std::string mark = row.value == "-" ? "" : status_mark(status);
  return fmt::format("<div><dt>{}</dt><dd>{}{}{}</dd></div>\n", formula_text(words), text(shown), small(row.interval),
                     mark);
}

/// The headline number of a fitted parameter.
std::string key_parameter(const FitResult& fit, ParameterId id) {
  const Parameter* const parameter = fit.find(id);
  if (parameter == nullptr) return key_number(info(id).words, estimate_row(Estimate{}, std::string()), {});
  return key_number(info(id).words, parameter_row(*parameter), name_of(parameter->status));
}

/// The critical speed; where it is not known, stick-slip at the speed of the recording is a lower bound.
std::string key_critical_speed(const Source& source) {
  const Conditions& conditions = source.recording.conditions();
  const Quantity& quantity = quantity_with_key("critical_speed_m_per_s");
  const bool sticks = source.analysis.motion == MotionClass::StickSlip;
  const Parameter* const zeta = source.analysis.fit->find(ParameterId::DampingRatio);  // on which it depends
  return key_number(quantity.words, estimate_row(quantity, source.analysis.derived.critical_speed_m_per_s, conditions),
                    zeta != nullptr ? name_of(zeta->status) : "derived",
                    sticks ? "above " + speed_text(conditions) : "not known");
}

std::vector<std::string> each(const std::vector<std::string>& sentences, std::string (*to_markup)(std::string_view)) {
  std::vector<std::string> items;
  items.reserve(sentences.size());
  for (const std::string& sentence : sentences) items.push_back(to_markup(sentence));
  return items;
}

}  // namespace

std::string quantity_cell(const Estimate& SI, double per_SI, const std::string& status) {
  const EstimateRow shown = estimate_row(SI, DisplayUnit{per_SI, ""});
  const std::string value = SI.value ? fmt::format("{}", *SI.value) : std::string();
  return fmt::format(R"(<td class="number" data-value="{}">{}{}{}</td>)", value, text(shown.value),
                     small(shown.interval), status_mark(status));
}

std::string capitalised(std::string sentence) {
  if (!sentence.empty())
    sentence.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence.front())));
  return sentence;
}

std::string command_fact(const std::string& command_line) {
  return command_line.empty() ? "" : "<dt>command</dt><dd><code>" + text(command_line) + "</code></dd>\n";
}

std::string motion_sentence(const Source& source) {
  const Analysis& analysis = source.analysis;
  const Estimate& frequency = analysis.frequency.quoted;
  const std::string rate = frequency.value ? unbroken(with_error(frequency) + " Hz") : std::string();
  const std::string speed = unbroken(speed_text(source.recording.conditions()));
  switch (analysis.motion) {
    case MotionClass::StickSlip: {
      if (rate.empty()) return text("Stick-slip of undetermined frequency.");
      const Estimate& spacing = analysis.derived.pattern_spacing_m;
      const std::string pattern =
          spacing.value ? fmt::format(" a pattern of {} spacing at", quantity_of(spacing, "m")) : std::string(" at");
      return text(fmt::format("Stick-slip at {}:{} {}.", rate, pattern, speed));
    }
    case MotionClass::SteadySliding:
      return text(fmt::format("Steady sliding at {}: no stick-slip, no pattern.", speed));
    case MotionClass::OscillatorySlip:
      return text(fmt::format("Oscillatory slip{}: almost no sticks.", rate.empty() ? "" : " at " + rate));
    case MotionClass::Undetermined:
      break;
  }
  return "The data do not determine whether this is stick-slip.";
}

std::string key_numbers(const Source& source) {
  const Analysis& analysis = source.analysis;
  if (analysis.motion == MotionClass::SteadySliding) return {};
  const Conditions& conditions = source.recording.conditions();
  const auto measured = [&conditions](const Quantity& quantity, const Estimate& estimate) {
    return key_number(quantity.words, estimate_row(quantity, estimate, conditions), "measured");
  };
  std::string numbers =
      measured(kFrequency, analysis.frequency.quoted) + measured(kMeasured.front(), analysis.derived.pattern_spacing_m);
  if (analysis.fit) {
    numbers += key_parameter(*analysis.fit, ParameterId::Stiffness) +
               key_parameter(*analysis.fit, ParameterId::DampingRatio) + key_critical_speed(source);
  }
  return "<dl class=\"keys\">\n" + numbers + "</dl>\n<p class=\"guide\">In brackets: 95 % intervals.</p>\n";
}

std::string warnings_part(const Warnings& warnings) {
  std::string doubts;
  std::string facts;
  for (const Warning& warning : warnings) {
    (is_fact(warning) ? facts : doubts) +=
        fmt::format("<li>{} <code>{}</code></li>\n", capitalised(formula_text(warning.message)), text(warning.code));
  }
  const auto box = [](const char* kind, const char* title, const std::string& items) {
    if (items.empty()) return items;
    return fmt::format("<div class=\"{}\" role=\"note\"><strong>{}</strong>\n<ul>\n{}</ul></div>\n", kind, title,
                       items);
  };
  return box("warnings", "Warnings", doubts) + box("warnings facts-known", "Accounted for in the analysis", facts);
}

std::string parameter_table(const FitResult& fit) {
  std::vector<std::vector<std::string>> rows;
  for (const ShownParameter& parameter : shown_parameters(fit)) {
    const std::string note =
        parameter.note.empty() ? "" : "<span class=\"note\">" + formula_text(parameter.note) + "</span>";
    rows.push_back({formula_text(parameter.words), text(parameter.numbers.value), text(parameter.numbers.unit),
                    text(parameter.numbers.interval),
                    fmt::format("<span class=\"status {0}\">{0}</span>{1}", name_of(parameter.status), note)});
  }
  return table(" class=\"parameters\"", {"parameter", "#value", "~unit", "~95 % interval", "status"}, rows) +
         list(each(status_meanings(fit.parameters), text));
}

std::string block_content(const Block& block) {
  std::vector<std::vector<std::string>> rows;
  for (const Row& row : block.rows) {
    rows.push_back({formula_text(row.label), text(row.value), text(row.unit), text(row.interval),
                    capitalised(formula_text(row.note))});
  }
  std::vector<std::string> sentences;
  for (const std::string& sentence : block.sentences) sentences.push_back(capitalised(formula_text(sentence)));
  return (rows.empty() ? "" : table(" class=\"parameters\"", {"", "#", "~", "~", ""}, rows)) + list(sentences);
}

std::string block_part(const Block& block) {
  if (block.empty()) return {};
  return section(fmt::format(" id=\"{}\" class=\"flows\"", block.id), text(block.title), block_content(block));
}

std::string parameters_part(const Source& source) {
  const Analysis& analysis = source.analysis;
  const auto part = [](const std::string& content) {
    return section(" id=\"parameters\"", "Parameters of the model", content);
  };
  if (!analysis.fit || analysis.motion == MotionClass::SteadySliding) {
    const char* why = analysis.motion == MotionClass::SteadySliding
                          ? "None: the model describes stick-slip, which this recording does not show."
                          : "None: the model was not fitted, or there are too few cycles to fit.";
    return part(fmt::format("<p class=\"absent\">{}</p>\n", why));
  }
  const FitResult& fit = *analysis.fit;
  const bool is_doubtful = analysis.motion == MotionClass::Undetermined;
  return part((is_doubtful ? "<p>Unreliable: the motion may not be stick-slip.</p>\n" : "") + parameter_table(fit));
}

std::string repeat_part(const Source& source, const ReportOrigin& origin) {
  const Conditions& conditions = source.recording.conditions();
  const Provenance& provenance = source.recording.provenance();
  std::string facts = fact("program", fmt::format("slipfit {}", SLIPFIT_VERSION)) +
                      fact("file", provenance.file.empty() ? "not from a file" : provenance.file) +
                      "<dt>digest of its bytes</dt><dd><code>" +
                      (provenance.input_digest ? provenance.input_digest->text() : "none") + "</code></dd>\n";
  facts += command_fact(origin.command_line);
  facts += fact("driving speed", speed_text(conditions));
  if (conditions.speed_standard_error_m_per_s) {
    facts += fact("its standard error",
                  stated_text(*conditions.speed_standard_error_m_per_s,
                              speed_unit(conditions.speed_unit, conditions.speed_standard_error_m_per_s)));
  }
  facts += fact("normal force",
                conditions.normal_force_N ? stated_text(*conditions.normal_force_N, "N") : std::string("not given"));
  facts += fact("force that the sensor measures", name_of(conditions.force_view));
  facts += fact("sensor's zero",
                conditions.zero_force_N ? stated_text(*conditions.zero_force_N, "N") : std::string("not given"));
  const std::string assumed = list(each(provenance.assumed, text));
  return section(" id=\"repeat\"", "To repeat this",
                 fact_list(facts) + (assumed.empty() ? "" : "<p>Assumed while reading:</p>\n" + assumed));
}

}  // namespace slipfit::html
