#include <fmt/format.h>

#include "report/names.hpp"
#include "report/rounding.hpp"
#include "report/table.hpp"
#include "report/text_sections.hpp"
#include "slipfit/report/sweep.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {
namespace {

template <class Unit>
std::string estimate_cell(const Estimate& estimate, const Unit& unit) {
  if (!estimate.value) return "-";
  const EstimateRow row = estimate_row(estimate, unit);
  return fmt::format("{} {} {}", row.value, row.unit, row.interval);
}

std::string off_by(const Estimate& predicted, const Estimate& measured) {
  if (!predicted.value || !measured.value) return "";
  return fmt::format("{:+.1f} %", 100.0 * (*predicted.value / *measured.value - 1.0));
}

std::string recordings_text(std::span<const SweepEntry> entries, const SweepAnalysis& sweep) {
  Table table({Align::Left, Align::Right, Align::Left, Align::Left, Align::Left, Align::Left, Align::Right});
  table.add(
      {"recording", "speed", "shows", "kinetic friction", "spacing measured (V/f)", "predicted without it", "off by"});
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const SweepPoint* point = sweep.joint ? &sweep.joint->points[i] : nullptr;
    const Estimate& measured = sweep.recordings[i].derived.pattern_spacing_m;
    table.add({one_line(entries[i].id), speed_text(entries[i].recording.conditions()),
               fmt::format("{}{}", plain_words(name_of(sweep.recordings[i].verdict)),
                           sweep.roles[i] == SweepRole::LeftOut ? " (left out)" : ""),
               point != nullptr ? estimate_cell(point->kinetic_friction_N, "N") : "-", estimate_cell(measured, "m"),
               point != nullptr ? estimate_cell(point->spacing_left_out_m, "m") : "-",
               point != nullptr ? off_by(point->spacing_left_out_m, measured) : ""});
  }
  return "\nRecordings\n" + table.text();
}

std::string limit_text(std::span<const SweepEntry> entries, const Derived& derived) {
  const Estimate& speed = derived.critical_speed_m_per_s;
  std::string text = "\nEnd of stick-slip by the fitted model\n  critical speed  ";
  if (!speed.value || !speed.note.empty()) return text + one_line(speed.note) + "\n";
  return text +
         fmt::format("{}, lambda at it {}\n",
                     estimate_cell(speed, speed_unit(entries.front().recording.conditions().speed_unit, speed.value)),
                     estimate_cell(derived.lambda_critical, ""));
}

}  // namespace

std::string to_text(std::span<const SweepEntry> entries, const SweepAnalysis& sweep, const std::string& name) {
  std::string text = fmt::format("{}: {} recordings fitted together\n", one_line(name), entries.size());
  if (!sweep.joint)
    text = fmt::format("{}: {} recordings, no joint fit: {}\n", one_line(name), entries.size(), sweep.joint_reason);
  if (sweep.joint) text += parameters_text(sweep.joint->fit, ForceQuantity::Force_N, "");
  text += recordings_text(entries, sweep);
  if (sweep.joint) text += limit_text(entries, sweep.derived);
  return text + warnings_text(sweep.warnings);
}

}  // namespace slipfit
