#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "io/cells.hpp"
#include "io/message.hpp"
#include "slipfit/core/units.hpp"
#include "slipfit/io/manifest_entry.hpp"

/// What a cell of text in a manifest sets, or the error that it is.
namespace slipfit::reading {

inline ManifestEntry& owner_of(auto ManifestEntry::* /*member*/, ManifestEntry& entry) {
  return entry;
}
inline Conditions& owner_of(auto Conditions::* /*member*/, ManifestEntry& entry) {
  return entry.conditions;
}
inline ReadOptions& owner_of(auto ReadOptions::* /*member*/, ManifestEntry& entry) {
  return entry.options;
}

template <auto member>
void set_number_of(ManifestEntry& entry, double number) {
  owner_of(member, entry).*member = number;
}

template <auto member>
std::optional<Error> set_text_of(ManifestEntry& entry, const std::string& cell) {
  owner_of(member, entry).*member = cell;
  return std::nullopt;
}

inline std::optional<Error> set_id(ManifestEntry& entry, const std::string& cell) {
  const bool has_slash = cell.find_first_of("/\\") != std::string::npos;
  const bool has_control =
      std::ranges::any_of(cell, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
  if (has_slash || has_control || cell.starts_with("group:")) {
    return refusal("bad_id", cell, "a name without slash or control character that does not begin with 'group:'");
  }
  entry.id = to_utf8(cell);
  return std::nullopt;
}

template <auto Labels::*target>
std::optional<Error> set_label(ManifestEntry& entry, const std::string& cell) {
  entry.conditions.labels.*target = to_utf8(cell);
  return std::nullopt;
}

inline std::optional<Error> set_force_view(ManifestEntry& entry, const std::string& cell) {
  constexpr auto kViews = std::to_array<std::pair<std::string_view, ForceView>>(
      {{"spring", ForceView::Spring}, {"transmitted", ForceView::Transmitted}, {"contact", ForceView::Contact}});
  const auto* const view = std::ranges::find_if(kViews, [&](const auto& v) { return v.first == cell; });
  if (view == kViews.end()) return refusal("unknown_force_view", cell, "spring, transmitted or contact");
  entry.conditions.force_view = view->second;
  return std::nullopt;
}

template <Dimension dimension, std::optional<std::string> ReadOptions::*target>
std::optional<Error> set_unit(ManifestEntry& entry, const std::string& cell) {
  const Result<UnitScale> unit = parse_unit(cell, dimension);
  const bool is_coefficient = dimension == Dimension::Force && parse_unit(cell, Dimension::Dimensionless);
  if (!unit && !is_coefficient) return Error{"unknown_unit", printable(unit.error().message)};
  entry.options.*target = cell;
  return std::nullopt;
}

inline std::optional<Error> set_step(ManifestEntry& entry, const std::string& cell) {
  const double step = plain_number(cell, false);
  if (!(step >= 0.0 && step < 1e9 && step == std::floor(step)))
    return refusal("bad_step", cell, "the number of a step, as slipfit info lists it");
  entry.options.step = static_cast<std::size_t>(step);
  return std::nullopt;
}

inline std::optional<Error> set_rows(ManifestEntry& entry, const std::string& cell) {
  entry.options.rows = parse_row_range(cell);
  return entry.options.rows ? std::nullopt : refusal("bad_rows", cell, "A:B with 1 <= A < B, rows counted from 1");
}

inline std::optional<Error> set_where(ManifestEntry& entry, const std::string& cell) {
  entry.options.where = parse_column_value(cell);
  return entry.options.where ? std::nullopt : refusal("bad_where", cell, "COLUMN=VALUE");
}

/// Strokes or segments.
inline std::optional<Error> set_pieces(ManifestEntry& entry, const std::string& cell, Pieces pieces) {
  if (entry.options.pieces != Pieces::One) return refusal("conflicting_pieces", cell, "either strokes or segments");
  entry.options.pieces = pieces;
  return std::nullopt;
}

inline std::optional<Error> set_strokes(ManifestEntry& entry, const std::string& cell) {
  const auto strokes = parse_strokes(cell);
  return strokes ? set_pieces(entry, cell, *strokes) : refusal("bad_strokes", cell, "both, positive or negative");
}

inline std::optional<Error> set_segments(ManifestEntry& entry, const std::string& cell) {
  if (cell == "no") return std::nullopt;
  return cell == "yes" ? set_pieces(entry, cell, Pieces::Segments) : refusal("bad_segments", cell, "yes or no");
}

inline std::optional<Error> set_force_scale(ManifestEntry& entry, const std::string& cell) {
  entry.options.force_scale = cell;
  return parse_force_scale(cell) ? std::nullopt : refusal("unknown_unit", cell, "newtons for a unit, such as 5 N/V");
}

}  // namespace slipfit::reading
