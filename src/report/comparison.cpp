#include "slipfit/report/comparison.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>

#include "core/unknown.hpp"
#include "report/comparison_rows.hpp"
#include "report/format.hpp"
#include "report/json_values.hpp"
#include "report/text_sections.hpp"
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
  return *p < kSmallest ? "< 0.0001" : fmt::format("{:.2g}", *p);
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

/// "10 mm/s", "10 to 50 mm/s"; empty if no recording states it.
std::string range_text(const ComparisonSide& side, ComparedCondition condition, const std::string& SI_unit) {
  const std::optional<Interval> range = range_of(side, condition);
  if (!range) return {};
  const DisplayUnit unit = display_unit(SI_unit, range->high);
  const std::string from =
      range->low < range->high ? fmt::format("{:.4g} to ", range->low * unit.per_SI) : std::string();
  return fmt::format(", {}{:.4g} {}", from, range->high * unit.per_SI, unit.unit);
}

}  // namespace

std::string side_text(const ComparisonSide& side) {
  std::vector<std::string> motions;
  for (const ComparedFit& fit : side.fits) {
    const std::string motion = plain_words(fit.motion);
    if (std::ranges::find(motions, motion) == motions.end()) motions.push_back(motion);
  }
  return fmt::format("{} ({}, {}{}{})", printable(side.name),
                     side.fits.size() == 1 ? "one recording" : fmt::format("{} recordings", side.fits.size()),
                     printable(fmt::format("{}", fmt::join(motions, ", "))),
                     range_text(side, &ComparedFit::speed_m_per_s, "m/s"),
                     range_text(side, &ComparedFit::normal_force_N, "N"));
}

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
    if (differing <= kMostNamed) names += (names.empty() ? ": " : ", ") + quantity.quantity.words;
  }
  if (compared == 0) return "No quantity is known on both sides: nothing can be compared.";
  const std::string quantities = compared == 1 ? "the one quantity" : fmt::format("any of {} quantities", compared);
  if (differing == 0) return fmt::format("No difference is shown in {}.", quantities);
  return fmt::format("A and B differ in {} of {} quantities{}.", differing, compared,
                     differing > kMostNamed ? std::string() : names);
}

std::vector<ComparisonRow> comparison_rows(const Comparison& comparison) {
  std::vector<ComparisonRow> rows;
  for (const QuantityComparison& quantity : comparison.quantities) {
    if (!quantity.difference.value) continue;
    const std::string& SI_unit = quantity.quantity.unit;
    const DisplayUnit unit = display_unit(SI_unit, quantity.a.estimate.value);
    ComparisonRow row;
    row.words = quantity.quantity.words + (unit.unit.empty() ? "" : " [" + unit.unit + "]");
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

std::vector<NotCompared> not_compared(const Comparison& comparison) {
  std::vector<NotCompared> all;
  for (const QuantityComparison& quantity : comparison.quantities) {
    if (quantity.difference.value) continue;
    const std::string& reason = quantity.difference.note;
    const auto same = std::ranges::find_if(all, [&](const NotCompared& one) { return one.reason == reason; });
    if (same == all.end()) {
      all.push_back({quantity.quantity.words, reason});
    } else {
      same->words += ", " + quantity.quantity.words;
    }
  }
  return all;
}

std::string to_json(const Comparison& comparison) {
  Json quantities = Json::object();
  for (const QuantityComparison& quantity : comparison.quantities) {
    quantities[quantity.quantity.key] = quantity_json(quantity);
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
  text += "  5 % level for all quantities together (p adjusted by Holm); 95 % intervals for each quantity\n\n";
  Table table({Align::Left, Align::Right, Align::Right, Align::Right, Align::Left, Align::Right, Align::Left});
  table.add({"", "A", "B", "B - A", "", "B / A", "p (Holm)"});
  Footnotes notes;
  for (const ComparisonRow& row : comparison_rows(comparison)) {
    table.add({row.words, row.a.value, row.b.value, row.difference.value, row.difference.interval, row.ratio.value,
               row.p_adjusted + (row.differs ? " *" : "") + notes.mark(row.note)});
  }
  text += table.text() + notes.text();
  const std::vector<NotCompared> left = not_compared(comparison);
  if (!left.empty()) text += "\nNot compared\n";
  for (const NotCompared& one : left) text += wrapped_text("  ", one.words + ": " + printable(one.reason));
  return text + warnings_text(comparison.warnings);
}

}  // namespace slipfit
