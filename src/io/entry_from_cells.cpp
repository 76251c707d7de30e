#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "io/manifest_columns.hpp"
#include "io/message.hpp"
#include "slipfit/core/units.hpp"
#include "slipfit/io/manifest_entry.hpp"

namespace slipfit {
namespace {

using namespace reading;

/// A rotation as the speed at the radius, which is read before it.
Result<std::string> with_radius(const std::string& text, const ManifestEntry& entry) {
  const auto rotation = parse_quantity(text, Dimension::AngularSpeed);
  if (parse_quantity(text, Dimension::Speed) || !rotation) return text;
  if (entry.options.radius_m) return fmt::format("{}", rotation.value() * *entry.options.radius_m);
  return Error{
      "out_of_range",
      fmt::format("column 'speed': '{}' is a rotation: add --radius, the distance of the contact from the axis",
                  printable(text))};
}

/// A percentage as a speed.
std::string with_speed(const std::string& text, const ManifestEntry& entry) {
  const auto share = parse_quantity(text, Dimension::Dimensionless);
  if (!text.ends_with('%') || !share) return text;
  return fmt::format("{}", share.value() * entry.conditions.speed_m_per_s);
}

Result<ManifestEntry> with_named(ManifestEntry entry, const NamedCell& cell) {
  const auto column = column_called(cell.column);
  if (!column) return Error{"unknown_option", fmt::format("there is no option '{}'", printable(cell.column))};
  std::string text = cell.text;
  const bool is_error = cell.column == "speed_se";
  if (is_error || cell.column == "speed") {
    auto speed = with_radius(text, entry);
    if (!speed) return speed.error();
    text = is_error ? with_speed(speed.value(), entry) : std::move(speed).value();
  }
  auto with = with_cell(std::move(entry), *column, text, false);
  if (!with || cell.column != "speed") return with;
  ManifestEntry known = std::move(with).value();
  known.conditions.speed_unit = unit_in(cell.text);
  return known;
}

}  // namespace

Result<ManifestEntry> entry_from_cells(std::span<const NamedCell> cells) {
  ManifestEntry entry;
  // The speed may hang on the radius, its error on the speed.
  for (const auto is_turn : {+[](std::string_view name) { return name != "speed" && name != "speed_se"; },
                             +[](std::string_view name) { return name == "speed"; },
                             +[](std::string_view name) { return name == "speed_se"; }}) {
    for (const NamedCell& cell : cells) {
      if (!is_turn(cell.column)) continue;
      auto with = with_named(std::move(entry), cell);
      if (!with) return with;
      entry = std::move(with).value();
    }
  }
  return entry;
}

}  // namespace slipfit
