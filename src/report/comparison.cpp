#include "slipfit/report/comparison.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>

#include "core/unknown.hpp"
#include "report/blocks.hpp"
#include "report/format.hpp"
#include "report/html/figure.hpp"
#include "report/html/page.hpp"
#include "report/json_values.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {

namespace {

Json side_json(const ComparisonSide& side) {
  return Json{{"name", side.name}, {"recordings", array_of(side.fits, [](const ComparedFit& fit) {
                                      return Json{{"id", fit.id},
                                                  {"file", text_or_null(fit.file)},
                                                  {"status", fit.motion},
                                                  {"speed_m_per_s", fit.speed_m_per_s},
                                                  {"normal_force_N", fit.normal_force_N}};
                                    })}};
}

Json side_estimate_json(const SideEstimate& side) {
  Json json = side.estimate;
  json["recordings"] = side.recordings;
  if (!side.status.empty()) json["status"] = side.status;
  return json;
}

Json quantity_json(const QuantityComparison& quantity) {
  return Json{{"a", side_estimate_json(quantity.a)},
              {"b", side_estimate_json(quantity.b)},
              {"difference", quantity.difference},
              {"ratio", quantity.ratio},
              {"p_value", quantity.p_value},
              {"p_adjusted", quantity.p_adjusted},
              {"method", quantity.method}};
}

std::string p_text(std::optional<double> p) {
  constexpr double kSmallest = 1e-4;
  if (!p) return "-";
  return *p < kSmallest ? "<0.0001" : fmt::format("{:.2g}", *p);
}

std::string note_of(const QuantityComparison& quantity) {
  std::string note;
  if (!quantity.ratio.value) add_note(note, "no ratio: " + printable(quantity.ratio.note));
  const auto add_status = [&](const char* side, const std::string& status) {
    if (status == "weak" || status == "conditional") add_note(note, status + " in " + side);
  };
  if (quantity.a.status == quantity.b.status) {
    add_status("both", quantity.a.status);
  } else {
    add_status("A", quantity.a.status);
    add_status("B", quantity.b.status);
  }
  return note;
}

/// "fdm_232g (3 recordings, stick-slip, 1.67 mm/s, 2.28 N)".
std::string side_text(const ComparisonSide& side) {
  std::vector<std::string> motions;
  for (const ComparedFit& fit : side.fits) {
    const std::string motion = plain_words(fit.motion);
    if (std::ranges::find(motions, motion) == motions.end()) motions.push_back(motion);
  }
  std::string about = side.fits.size() == 1 ? "one recording" : fmt::format("{} recordings", side.fits.size());
  about += ", " + printable(fmt::format("{}", fmt::join(motions, ", ")));
  for (const std::string& condition :
       {condition_text(side, &ComparedFit::speed_m_per_s), condition_text(side, &ComparedFit::normal_force_N)}) {
    if (!condition.empty()) about += ", " + condition;
  }
  return fmt::format("{} ({})", printable(side.name), about);
}

/// "A and B differ in 2 of 9 quantities: ..., ...".
std::string comparison_sentence(const Comparison& comparison) {
  constexpr std::size_t kMostNamed = 3;
  std::string names;
  std::size_t differing = 0;
  std::size_t compared = 0;
  for (const QuantityComparison& quantity : comparison.quantities) {
    if (!quantity.p_value) continue;
    ++compared;
    if (!quantity.differs()) continue;
    ++differing;
    if (differing <= kMostNamed) names += (names.empty() ? ": " : ", ") + full_words(quantity.quantity);
  }
  if (compared == 0) return "No quantity is known on both sides: nothing can be compared.";
  const std::string quantities = compared == 1 ? "the one quantity" : fmt::format("any of {} quantities", compared);
  if (differing == 0) return fmt::format("No difference is shown in {}.", quantities);
  return fmt::format("A and B differ in {} of {} quantities{}.", differing, compared,
                     differing > kMostNamed ? std::string() : names);
}

/// A quantity that was compared, as one row of a table for people.
struct ComparisonRow {
  std::string words;  ///< with the unit
  EstimateRow a, b, difference, ratio;
  std::string p_value, p_adjusted;
  std::string note;  ///< why there is no ratio; what a status asks for
  bool differs = false;
};
std::vector<ComparisonRow> comparison_rows(const Comparison& comparison) {
  std::vector<ComparisonRow> rows;
  for (const QuantityComparison& quantity : comparison.quantities) {
    if (!quantity.difference.value) continue;
    const std::string SI_unit(quantity.quantity.unit);
    const DisplayUnit unit = display_unit(SI_unit, quantity.a.estimate.value);
    ComparisonRow row;
    row.words = full_words(quantity.quantity) + (unit.unit.empty() ? "" : " [" + unit.unit + "]");
    row.a = estimate_row(quantity.a.estimate, unit);
    row.b = estimate_row(quantity.b.estimate, unit);
    row.difference = estimate_row(quantity.difference, unit);
    row.ratio = estimate_row(quantity.ratio, DisplayUnit{});
    row.p_value = p_text(quantity.p_value);
    row.p_adjusted = p_text(quantity.p_adjusted);
    row.note = note_of(quantity);
    row.differs = quantity.differs();
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Quantities that were not, by their common reason.
struct NotCompared {
  std::string words;
  std::string reason;
};
std::vector<NotCompared> not_compared(const Comparison& comparison) {
  std::vector<NotCompared> all;
  for (const QuantityComparison& quantity : comparison.quantities) {
    if (quantity.difference.value) continue;
    const std::string& reason = quantity.difference.note;
    const auto same = std::ranges::find_if(all, [&](const NotCompared& one) { return one.reason == reason; });
    if (same == all.end()) {
      all.push_back({full_words(quantity.quantity), reason});
    } else {
      same->words += ", " + full_words(quantity.quantity);
    }
  }
  return all;
}

}  // namespace

std::string to_json(const Comparison& comparison) {
  Json quantities = Json::object();
  for (const QuantityComparison& quantity : comparison.quantities) {
    quantities[std::string(quantity.quantity.key)] = quantity_json(quantity);
  }
  return text_of(Json{{"schema", "slipfit.compare/1"},
                      {"version", SLIPFIT_VERSION},
                      {"a", side_json(comparison.a)},
                      {"b", side_json(comparison.b)},
                      {"warnings", comparison.warnings},
                      {"quantities", std::move(quantities)}});
}

std::string to_text(const Comparison& comparison) {
  std::string text = fmt::format("A: {}\nB: {}\n\n{}\n", side_text(comparison.a), side_text(comparison.b),
                                 comparison_sentence(comparison));
  text += "  B - A is a 95 % interval; * differs at the 5 % level of all quantities together (p by Holm)\n\n";
  Table table({Align::Left, Align::Right, Align::Right, Align::Right, Align::Right, Align::Right});
  table.add({"", "A", "B", "B - A", "B / A", "p"});
  Footnotes notes;
  for (const ComparisonRow& row : comparison_rows(comparison)) {
    table.add({row.words + notes.mark(row.note), row.a.value, row.b.value, row.difference.interval, row.ratio.value,
               row.p_adjusted + (row.differs ? " *" : "  ")});
  }
  text += table.text() + notes.text();
  const std::vector<NotCompared> left = not_compared(comparison);
  if (!left.empty()) text += "\nNot compared\n";
  for (const NotCompared& one : left) text += wrapped_text("  ", one.words + ": " + printable(one.reason));
  return text + warnings_text(comparison.warnings);
}

namespace html {
namespace {

OverlaidSet side_of(const std::string& name, const std::vector<ComparedRecording>& recordings) {
  OverlaidSet set{name, {}};
  for (const ComparedRecording& one : recordings) set.recordings.push_back({one.recording, one.analysis});
  return set;
}

Figure both_cycles_figure(const ComparisonOrigin& origin) {
  Figure figure{"cycles", "Overlaid cycles of A and B"};
  figure.guide = std::string(kOverlayGuide);
  figure.label = "overlaid cycles of A and of B";
  const std::vector<OverlaidSet> sides{side_of("A", origin.recordings_a), side_of("B", origin.recordings_b)};
  if (has_cycles(sides.front()) && has_cycles(sides.back())) {
    figure.chart = overlay_of(figure.title, sides);
  } else {
    figure.absent =
        "Results of fits contain no traces, and steady sliding has no cycles: give the recordings themselves.";
  }
  return figure;
}

std::string quantities_part(const Comparison& comparison) {
  const auto number = [](const EstimateRow& row) { return Cell(text(row.value) + small(row.interval)); };
  std::vector<std::vector<Cell>> rows;
  for (const ComparisonRow& row : comparison_rows(comparison)) {
    rows.push_back({formula_text(row.words) + note(row.note), std::string(row.differs ? "yes" : "not shown"),
                    number(row.a), number(row.b), number(row.difference), number(row.ratio),
                    fmt::format("{}<small>alone: {}</small>", text(row.p_adjusted), text(row.p_value))});
  }
  std::vector<std::string> left_out;
  for (const NotCompared& one : not_compared(comparison))
    left_out.push_back(formula_text(one.words + ": " + one.reason));
  const std::string compared =
      rows.empty()
          ? absent("None.")
          : "<p class=\"guide\">In brackets: 95 % intervals. p: probability of at least this difference if A and B "
            "were equal, for all quantities together (Holm; different below 0.05) and for each quantity alone.</p>\n" +
                table(" class=\"plain-table\"", {"quantity", "differs", "#A", "#B", "#B - A", "#B / A", "#p"}, rows);
  return section(" id=\"quantities\" class=\"flows\"", "What is compared", compared) +
         (left_out.empty() ? "" : section(" id=\"absent\"", "What cannot be compared", list(left_out)));
}

std::string files_of(const Comparison& comparison) {
  std::string facts;
  for (const auto& [side, name] : {std::pair{&comparison.a, 'A'}, std::pair{&comparison.b, 'B'}}) {
    for (const ComparedFit& fit : side->fits) {
      facts += fact(fmt::format("{}: {}", name, fit.id), fit.file.empty() ? "several recordings" : fit.file);
    }
  }
  return facts;
}

}  // namespace
}  // namespace html

std::string to_html(const Comparison& comparison, const ComparisonOrigin& origin) {
  html::PageParts page;
  page.title = comparison.a.name + " and " + comparison.b.name;
  page.kind = "comparison";
  page.headline = html::formula_text(comparison_sentence(comparison));
  page.summary = html::fact_list(html::fact("A", side_text(comparison.a)) + html::fact("B", side_text(comparison.b))) +
                 html::warnings_part(comparison.warnings);
  page.main = html::quantities_part(comparison) + html::figure_part(html::both_cycles_figure(origin)) +
              html::repeat_part(" class=\"flows\"", origin.command_line, html::files_of(comparison));
  return html::page_from(page);
}

}  // namespace slipfit
