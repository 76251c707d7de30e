#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "core/statistics.hpp"
#include "report/html/figure.hpp"
#include "report/html/page.hpp"
#include "report/html/speed_figures.hpp"
#include "report/names.hpp"
#include "report/quantity_rows.hpp"
#include "report/text_sections.hpp"
#include "slipfit/report/sweep_html.hpp"

namespace slipfit {
namespace html {
namespace {

std::string sweep_sentence(const SweepSource& source) {
  if (!source.sweep.fit) return fmt::format("{} recordings, no joint fit.", source.entries.size());
  const Estimate& critical = source.sweep.derived.critical_speed_m_per_s;
  // The interval and not the standard error: it may be lopsided, and few recordings make it wide.
  const std::string end =
      critical.value
          ? ": stick-slip ends at " + estimate_text(critical, speed_unit(given_speed_unit(source), critical.value))
          : std::string(": the end of stick-slip is unknown");
  const auto left_out = std::ranges::count(source.sweep.roles, SweepRole::LeftOut);
  const auto fitted = static_cast<std::ptrdiff_t>(source.entries.size()) - left_out;
  return text(fmt::format("{} recordings, {} fitted together{}.", source.entries.size(), fitted, end));
}

std::string parameters_of(const SweepAnalysis& sweep) {
  return section(" id=\"parameters\"", "Parameters of all recordings",
                 sweep.fit ? parameter_table(sweep.fit->result)
                           : "<p class=\"absent\">" + formula_text(sweep.fit_reason) + "</p>\n") +
         (sweep.fit ? block_part(correlations_block(sweep.fit->result)) : std::string());
}

/// One unit a column: rows compare by eye.
struct SweepUnits {
  DisplayUnit speed;
  DisplayUnit spacing;
};

SweepUnits units_of(const SweepSource& source) {
  double widest_m = 0.0;
  for (std::size_t i = 0; i < source.entries.size(); ++i) {
    const Conditions& conditions = source.entries[i].recording.conditions();
    widest_m = std::max({widest_m, spacing_on_surface(conditions).value.value_or(0.0),
                         source.sweep.recordings[i].derived.pattern_spacing_m.value.value_or(0.0)});
  }
  return {speed_unit_of(source), display_unit("m", widest_m)};
}

/// Returns true if the manifest states the spacing on the worn surface for any recording.
bool has_surface_spacing(const SweepSource& source) {
  return std::ranges::any_of(source.entries, [](const SweepEntry& entry) {
    return spacing_on_surface(entry.recording.conditions()).value.has_value();
  });
}

/// Returns the changes of k and F_s - F_k if the recording is left out.
std::string influence_cells(const SweepSource& source, const SweepPoint& point) {
  const std::optional<ModelEstimate> whole = source.sweep.fit ? source.sweep.fit->result.estimate : std::nullopt;
  if (!whole) return {};
  const auto cell = [](const std::optional<double>& without, double with) {
    const std::string change = without ? fmt::format("{:+.2g} %", 100.0 * (*without / with - 1.0)) : "-";
    return "<td class=\"number\">" + change + "</td>";
  };
  return cell(point.stiffness_left_out_N_per_m, whole->stiffness_N_per_m) +
         cell(point.friction_difference_left_out_N, whole->friction_difference_N);
}

std::string recording_row(const SweepSource& source, std::size_t i, const SweepUnits& units) {
  const Analysis& analysis = source.sweep.recordings[i];
  const Conditions& conditions = source.entries[i].recording.conditions();
  const Estimate on_surface = spacing_on_surface(conditions);
  const double speed = units.speed.per_SI * conditions.speed_m_per_s;
  const Estimate& measured = analysis.derived.pattern_spacing_m;
  const SweepPoint without = source.sweep.fit ? source.sweep.fit->points[i] : SweepPoint{};
  const Estimate& predicted = without.spacing_left_out_m;
  const bool is_left_out = source.sweep.roles[i] == SweepRole::LeftOut;
  return fmt::format(
      "<tr><th scope=\"row\">{}</th><td class=\"number\">{:.4g}</td><td>{}{}</td>{}{}{}<td "
      "class=\"number\">{}</td>{}</tr>\n",
      text(source.entries[i].id), speed, plain_words(name_of(analysis.motion)), is_left_out ? ", left out" : "",
      has_surface_spacing(source) ? quantity_cell(on_surface, units.spacing.per_SI) : "",
      quantity_cell(measured, units.spacing.per_SI), quantity_cell(predicted, units.spacing.per_SI),
      text(off_by(predicted, measured)), influence_cells(source, without));
}

std::string recordings_of(const SweepSource& source) {
  const SweepUnits units = units_of(source);
  std::vector<std::string> columns{"recording", label_with_unit("#speed", units.speed.unit), "shows"};
  if (has_surface_spacing(source)) columns.push_back(label_with_unit("#spacing on the surface", units.spacing.unit));
  columns.insert(columns.end(), {label_with_unit("#" + std::string(kMeasured.front().words), units.spacing.unit),
                                 label_with_unit("#predicted from the others", units.spacing.unit), "#off by"});
  if (source.sweep.fit && source.sweep.fit->result.estimate) {
    columns.insert(columns.end(), {"#k without it", "#F_s \u2212 F_k without it"});
  }
  std::string rows;
  for (std::size_t i = 0; i < source.entries.size(); ++i) rows += recording_row(source, i, units);
  return section(" class=\"flows\"", "Each recording, predicted from the others",
                 table(" class=\"plain-table\"", columns, rows));
}

std::string traces_of(const SweepSource& source) {
  std::string parts;
  for (const Figure& figure : sweep_traces_figures(source)) parts += figure_part(figure);
  return parts;
}

std::string repeat_of(const SweepSource& source, const SweepOrigin& origin) {
  std::string facts = fact("program", fmt::format("slipfit {}", SLIPFIT_VERSION)) + command_fact(origin.command_line);
  for (std::size_t i = 0; i < source.entries.size(); ++i) {
    const Provenance& provenance = source.entries[i].recording.provenance();
    const bool is_of_same_file = i > 0 && source.entries[i - 1].recording.provenance().file == provenance.file;
    if (is_of_same_file) continue;  // strokes, segments
    facts += fmt::format("<dt>{}</dt><dd>{}<br><code>{}</code></dd>\n", text(source.entries[i].id),
                         text(provenance.file), provenance.input_digest ? provenance.input_digest->text() : "");
  }
  constexpr std::size_t kMostTogether = 12;  // on a printed page
  const bool is_short = source.entries.size() <= kMostTogether;
  return section(is_short ? " id=\"repeat\"" : " id=\"repeat\" class=\"flows\"", "To repeat this", fact_list(facts));
}

}  // namespace

std::vector<std::size_t> by_speed(const SweepSource& source) {
  std::vector<std::size_t> order(source.entries.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto speed = [&source](std::size_t i) { return source.entries[i].recording.conditions().speed_m_per_s; };
  std::ranges::stable_sort(order, [&speed](std::size_t a, std::size_t b) { return speed(a) < speed(b); });
  return order;
}

Estimate spacing_on_surface(const Conditions& conditions) {
  if (conditions.worn_track) return conditions.worn_track->spacing_m;
  const std::optional<double>& stated_m = conditions.measured_spacing_m;
  const std::optional<double>& se_m = conditions.measured_spacing_se_m;
  if (!stated_m || !se_m) return {stated_m, {}, {}, {}};
  return symmetric(*stated_m, *se_m);
}

DisplayUnit speed_unit_of(const SweepSource& source) {
  return speed_unit(given_speed_unit(source),
                    source.entries[by_speed(source).back()].recording.conditions().speed_m_per_s);
}

const std::string& given_speed_unit(const SweepSource& source) {
  return source.entries.front().recording.conditions().speed_unit;
}

}  // namespace html

std::string to_html(std::span<const SweepEntry> entries, const SweepAnalysis& sweep,
                    const std::optional<Prediction>& prediction, const SweepOrigin& origin) {
  const html::SweepSource source{entries, sweep, prediction};
  html::PageParts page;
  page.title = origin.name;
  page.kind = "sweep";
  page.headline = html::sweep_sentence(source);
  page.summary =
      "<p class=\"reason\">" + html::formula_text(sweep.fit_reason) + "</p>\n" + html::warnings_part(sweep.warnings);
  page.main = html::parameters_of(sweep) + html::figure_part(html::sweep_spacing_figure(source)) +
              html::figure_part(html::sweep_friction_figure(source)) + html::recordings_of(source) +
              html::block_part(repeats_block(sweep.repeats)) + html::figure_part(html::sweep_cycles_figure(source)) +
              html::traces_of(source) + html::repeat_of(source, origin);
  return html::page_from(page);
}

}  // namespace slipfit
