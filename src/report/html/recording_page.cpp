// The page of one recording.

#include <fmt/format.h>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "report/blocks.hpp"
#include "report/html/assets.hpp"
#include "report/html/page.hpp"
#include "report/names.hpp"
#include "report/quantity_rows.hpp"

namespace slipfit {
namespace html {

Source source_of(const Recording& recording, const Analysis& analysis, const Background& background) {
  return {recording,
          analysis,
          background,
          force_unit_of(recording),
          fitted_force(recording, analysis),
          force_without_interference(recording, analysis)};
}

bool shows_cycles(const Analysis& analysis) {
  return analysis.motion != MotionClass::SteadySliding;
}

bool has_fitted_curve(const Analysis& analysis) {
  return shows_cycles(analysis) && analysis.fit && !analysis.fit->curve.empty();
}

std::vector<Figure> figures_of(const Source& source) {
  return {trace_figure(source),     spectrum_figure(source),  cycles_figure(source),
          residuals_figure(source), evolution_figure(source), pairs_figure(source),
          map_figure(source),       speed_figure(source),     pattern_figure(source)};
}

namespace {

/// The name of the file; "recording" where there is none.
std::string title_of(const Recording& recording) {
  const std::string name = std::filesystem::path(recording.provenance().file).filename().string();
  return name.empty() ? "recording" : name;
}

/// The path of the file, and its entry in the manifest.
std::string place_of(const Recording& recording) {
  const std::string& file = recording.provenance().file;
  const Labels& labels = recording.conditions().labels;
  std::string place = file == title_of(recording) || file.empty() ? "" : "<p class=\"file\">" + text(file) + "</p>\n";
  std::string facts;
  for (const auto& [term, label] : {std::pair{"sample", &labels.sample},
                                    {"material", &labels.material},
                                    {"operator", &labels.operator_name},
                                    {"group", &labels.group}}) {
    if (!label->empty()) facts += (facts.empty() ? "" : " · ") + fmt::format("{}: {}", term, text(*label));
  }
  return facts.empty() ? place : place + "<p class=\"file\">" + facts + "</p>\n";
}

std::string motion_sentence(const Source& source) {
  const Analysis& analysis = source.analysis;
  const Estimate& frequency = analysis.frequency.quoted;
  const std::string rate = frequency.value ? unbroken(with_error(frequency) + " Hz") : std::string();
  const std::string speed = unbroken(speed_text(source.recording.conditions()));
  switch (analysis.motion) {
    case MotionClass::StickSlip: {
      if (rate.empty()) return "Stick-slip of undetermined frequency.";
      const Estimate& spacing = analysis.derived.pattern_spacing_m;
      const std::string pattern =
          spacing.value ? fmt::format(" a pattern of {} spacing at", quantity_of(spacing, "m")) : std::string(" at");
      return fmt::format("Stick-slip at {}:{} {}.", rate, pattern, speed);
    }
    case MotionClass::SteadySliding:
      return fmt::format("Steady sliding at {}: no stick-slip, no pattern.", speed);
    case MotionClass::OscillatorySlip:
      return fmt::format("Oscillatory slip{}: almost no sticks.", rate.empty() ? "" : " at " + rate);
    case MotionClass::Undetermined:
      break;
  }
  return "The data do not determine whether this is stick-slip.";
}

/// A headline number: its value, interval and status. `unknown_text` replaces a value that is not known.
std::string key_number(std::string_view words, const EstimateRow& row, std::string_view status,
                       const std::string& unknown_text = "not known") {
  const bool is_known = row.value != "-";
  const std::string mark = is_known && !status.empty() ? "<small>" + status_mark(status) + "</small>" : "";
  return fmt::format("<div><dt>{}</dt><dd>{}{}{}</dd></div>\n", formula_text(words),
                     text(is_known ? value_text(row) : unknown_text), small(row.interval), mark);
}

/// The headline number of a fitted parameter.
std::string key_parameter(const FitResult& fit, ParameterId id) {
  const Parameter* const parameter = fit.find(id);
  if (parameter == nullptr) return key_number(info(id).words, {"-", {}, {}}, {});
  return key_number(info(id).words, parameter_row(*parameter), name_of(parameter->status));
}

/// Frequency, spacing, k, zeta and the critical speed; where that is not known, stick-slip at the speed of the
/// recording is a lower bound.
std::string key_numbers(const Source& source) {
  const Analysis& analysis = source.analysis;
  if (analysis.motion == MotionClass::SteadySliding) return {};
  const Conditions& conditions = source.recording.conditions();
  const auto row_of = [&](const Quantity& quantity, const Estimate& estimate) {
    return estimate_row(quantity, estimate, conditions);
  };
  std::string numbers =
      key_number(kFrequency.words, row_of(kFrequency, analysis.frequency.quoted), "measured") +
      key_number(kMeasured.front().words, row_of(kMeasured.front(), analysis.derived.pattern_spacing_m), "measured");
  if (analysis.fit) {
    const Quantity& critical = quantity_with_key("critical_speed_m_per_s");
    const Parameter* const zeta = analysis.fit->find(ParameterId::DampingRatio);  // on which it depends
    numbers += key_parameter(*analysis.fit, ParameterId::Stiffness) +
               key_parameter(*analysis.fit, ParameterId::DampingRatio) +
               key_number(critical.words, row_of(critical, analysis.derived.critical_speed_m_per_s),
                          zeta != nullptr ? name_of(zeta->status) : "derived",
                          analysis.motion == MotionClass::StickSlip ? "above " + speed_text(conditions) : "not known");
  }
  return "<dl class=\"keys\">\n" + numbers + "</dl>\n<p class=\"guide\">In brackets: 95 % intervals.</p>\n";
}

/// The chart, and the interactive trace that the script shows in its place where it can.
std::string trace_part(const Figure& figure, const Source& source) {
  const char* const slips = shows_cycles(source.analysis) ? "<span class=\"key slips\"></span>slips" : "";
  const char* const fit = has_fitted_curve(source.analysis) ? "<span class=\"key fit\"></span>fit" : "";
  return fmt::format(fmt::runtime(assets::trace_part()), fmt::arg("title", text(figure.title)),
                     fmt::arg("guide", formula_text(figure.guide)), fmt::arg("label", text(figure.label)),
                     fmt::arg("slips_key", slips), fmt::arg("fit_key", fit),
                     fmt::arg("chart", picture_of(*figure.chart, figure.id, figure.label)));
}

std::string parameters_part(const Analysis& analysis) {
  std::string content;
  if (analysis.motion == MotionClass::SteadySliding) {
    content = absent("None: the model describes stick-slip, which this recording does not show.");
  } else if (!analysis.fit) {
    content = absent("None: the model was not fitted, or there are too few cycles to fit.");
  } else {
    const bool is_doubtful = analysis.motion == MotionClass::Undetermined;
    content =
        (is_doubtful ? "<p>Unreliable: the motion may not be stick-slip.</p>\n" : "") + parameter_table(*analysis.fit);
  }
  return section(" id=\"parameters\"", "Parameters of the model", content);
}

/// The charts in their order; those that the recording does not allow are listed after them, in a few lines.
std::string figures_part(std::span<const Figure> figures) {
  std::string parts;
  std::string missing;
  for (const Figure& figure : figures) {
    if (figure.chart) {
      parts += figure_part(figure);
    } else {
      missing += "<dt>" + text(figure.title) + "</dt><dd>" + formula_text(figure.absent) + "</dd>\n";
    }
  }
  if (missing.empty()) return parts;
  return parts + section(" id=\"absent\"", "Charts that are not available", fact_list(missing));
}

/// The models that were compared, and correlated parameters; nothing in steady sliding.
std::string models_part(const Source& source) {
  if (!source.analysis.fit || !shows_cycles(source.analysis)) return {};
  const FitResult& fit = *source.analysis.fit;
  return block_part(models_block(fit, source.recording.conditions().quantity, FitKind::Single)) +
         block_part(correlations_block(fit));
}

/// Tables that the text report has, too, folded away.
std::string numbers_part(const Source& source) {
  std::string tables;
  for (const Block& block : number_blocks(source.recording, source.analysis))
    tables += "<h3>" + text(block.title) + "</h3>\n" + block_content(block);
  return section(" class=\"flows\" id=\"numbers\"", "All numbers",
                 "<details><summary>Frequency, cycles, spacing, prediction and tests as tables</summary>\n" + tables +
                     "</details>\n");
}

/// Returns the section with all that a reader needs to repeat the analysis.
std::string origin_part(const Recording& recording, const ReportOrigin& origin) {
  const Conditions& conditions = recording.conditions();
  const Provenance& provenance = recording.provenance();
  const auto stated = [](const std::optional<double>& value_N) {
    return value_N ? stated_text(*value_N, "N") : std::string("not given");
  };
  std::string facts =
      fact("file", provenance.file.empty() ? "not from a file" : provenance.file) +
      code_fact("digest of its bytes", provenance.input_digest ? provenance.input_digest->text() : "none") +
      fact("driving speed", speed_text(conditions));
  if (const auto error_m_per_s = conditions.speed_standard_error_m_per_s) {
    facts += fact("its standard error", stated_text(*error_m_per_s, speed_unit(conditions.speed_unit, error_m_per_s)));
  }
  facts += fact("normal force", stated(conditions.normal_force_N)) +
           fact("force that the sensor measures", name_of(conditions.force_view)) +
           fact("sensor's zero", stated(conditions.zero_force_N));
  std::vector<std::string> assumed;
  for (const std::string& sentence : provenance.assumed) assumed.push_back(text(sentence));
  return repeat_part("", origin.command_line, facts,
                     assumed.empty() ? "" : "<p>Assumed while reading:</p>\n" + list(assumed));
}

}  // namespace
}  // namespace html

std::string to_html(const Recording& recording, const Analysis& analysis, const Background& background,
                    const ReportOrigin& origin) {
  const html::Source source = html::source_of(recording, analysis, background);
  html::PageParts page;
  page.title = html::title_of(recording);
  page.kind = "recording";
  page.place = html::place_of(recording);
  page.headline = html::text(html::motion_sentence(source));
  page.summary = "<p class=\"reason\">" + html::sentence_text(analysis.motion_reason) + "</p>\n" +
                 html::key_numbers(source) + html::warnings_part(analysis.warnings);
  const std::vector<html::Figure> figures = html::figures_of(source);
  page.main = html::trace_part(figures.front(), source) + html::parameters_part(analysis) +
              html::block_part(coefficients_block(analysis.coefficients)) +
              html::figures_part(std::span(figures).subspan(1)) + html::models_part(source) +
              html::block_part(quality_block(recording, analysis)) + html::numbers_part(source) +
              html::origin_part(recording, origin);
  page.scripts = R"(<script type="application/json" id="trace-data">)" + html::trace_data(source) + "</script>\n" +
                 html::script_element(assets::trace_script());
  return html::page_from(page);
}

std::vector<PictureFile> report_pictures(const Recording& recording, const Analysis& analysis,
                                         const Background& background) {
  std::vector<PictureFile> files;
  for (const html::Figure& figure : html::figures_of(html::source_of(recording, analysis, background))) {
    if (figure.chart) files.push_back({figure.id + ".svg", to_svg(*figure.chart)});
  }
  return files;
}

}  // namespace slipfit
