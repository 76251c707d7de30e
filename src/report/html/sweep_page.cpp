#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "core/statistics.hpp"
#include "report/blocks.hpp"
#include "report/html/figure.hpp"
#include "report/html/page.hpp"
#include "report/html/speed_figures.hpp"
#include "report/names.hpp"
#include "report/quantity_rows.hpp"
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
                 sweep.fit ? parameter_table(sweep.fit->result) : absent(sweep.fit_reason)) +
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

/// Every recording with the prediction from the others, and what k and F_s - F_k are without it.
std::string recordings_of(const SweepSource& source) {
  const SweepUnits units = units_of(source);
  const bool has_surface = std::ranges::any_of(source.entries, [](const SweepEntry& entry) {
    return spacing_on_surface(entry.recording.conditions()).value.has_value();
  });
  const std::optional<ModelEstimate> whole = source.sweep.fit ? source.sweep.fit->result.estimate : std::nullopt;
  std::vector<std::string> headings{"recording", label_with_unit("#speed", units.speed.unit), "shows"};
  if (has_surface) headings.push_back(label_with_unit("#spacing on the surface", units.spacing.unit));
  headings.insert(headings.end(), {label_with_unit("#" + std::string(kMeasured.front().words), units.spacing.unit),
                                   label_with_unit("#predicted from the others", units.spacing.unit), "#off by"});
  if (whole) headings.insert(headings.end(), {"#k without it", "#F_s \u2212 F_k without it"});
  std::vector<std::vector<Cell>> rows;
  for (std::size_t i = 0; i < source.entries.size(); ++i) {
    const Analysis& analysis = source.sweep.recordings[i];
    const Conditions& conditions = source.entries[i].recording.conditions();
    const Estimate& measured = analysis.derived.pattern_spacing_m;
    const SweepPoint without = source.sweep.fit ? source.sweep.fit->points[i] : SweepPoint{};
    const bool is_left_out = source.sweep.roles[i] == SweepRole::LeftOut;
    std::vector<Cell>& row = rows.emplace_back();
    row = {text(source.entries[i].id), fmt::format("{:.4g}", units.speed.per_SI * conditions.speed_m_per_s),
           plain_words(name_of(analysis.motion)) + (is_left_out ? ", left out" : "")};
    if (has_surface) row.push_back(quantity_cell(spacing_on_surface(conditions), units.spacing.per_SI));
    row.push_back(quantity_cell(measured, units.spacing.per_SI));
    row.push_back(quantity_cell(without.spacing_left_out_m, units.spacing.per_SI));
    row.emplace_back(text(off_by(without.spacing_left_out_m, measured)));
    const auto add_change = [&row](const std::optional<double>& left_out, double with) {
      row.emplace_back(left_out ? fmt::format("{:+.2g} %", 100.0 * (*left_out / with - 1.0)) : "-");
    };
    if (!whole) continue;
    add_change(without.stiffness_left_out_N_per_m, whole->stiffness_N_per_m);
    add_change(without.friction_difference_left_out_N, whole->friction_difference_N);
  }
  return section(" class=\"flows\"", "Each recording, predicted from the others",
                 table(" class=\"plain-table\"", headings, rows));
}

std::string traces_of(const SweepSource& source) {
  std::string parts;
  for (const Figure& figure : sweep_traces_figures(source)) parts += figure_part(figure);
  return parts;
}

std::string repeat_of(const SweepSource& source, const SweepOrigin& origin) {
  std::string facts;
  for (std::size_t i = 0; i < source.entries.size(); ++i) {
    const Provenance& provenance = source.entries[i].recording.provenance();
    const bool is_of_same_file = i > 0 && source.entries[i - 1].recording.provenance().file == provenance.file;
    if (is_of_same_file) continue;  // strokes, segments
    facts += fmt::format("<dt>{}</dt><dd>{}<br><code>{}</code></dd>\n", text(source.entries[i].id),
                         text(provenance.file), provenance.input_digest ? provenance.input_digest->text() : "");
  }
  constexpr std::size_t kMostTogether = 12;  // on a printed page
  return repeat_part(source.entries.size() <= kMostTogether ? "" : " class=\"flows\"", origin.command_line, facts);
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
