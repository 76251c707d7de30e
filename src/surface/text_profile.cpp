#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "io/column_search.hpp"
#include "io/opened_file.hpp"
#include "io/text_lines.hpp"
#include "slipfit/core/units.hpp"
#include "surface/readers.hpp"

namespace slipfit::surface {
namespace {

using reading::CellKind;
using reading::Column;
using reading::Layout;

/// The columns to read; without positions the pitch defines them.
struct Choice {
  std::optional<std::size_t> x;
  std::size_t z = 0;
};

/// The column that an option names.
std::optional<std::size_t> named(const Layout& layout, const std::optional<std::string>& wanted, const char* option,
                                 const std::string& file) {
  if (!wanted) return std::nullopt;
  return reading::find_column(layout, *wanted, option, file);
}

bool is_counter(const Column& column) {
  return column.is_whole && column.is_regular && column.median_step == 1.0 && column.name.unit.empty();
}

/// Places rise along the track in (nearly) even steps; heights are what is left.
Choice choose(const Layout& layout, const ProfileOptions& options, const std::string& file) {
  Choice choice{named(layout, options.x_column, "--x-column", file), 0};
  const std::optional<std::size_t> z = named(layout, options.z_column, "--z-column", file);
  std::vector<std::size_t> heights;
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    const Column& column = layout.columns[c];
    if (!column.is_numeric() || c == z || c == choice.x) continue;
    if (column.never_decreases && is_counter(column) && layout.columns.size() > 2) continue;
    if (!choice.x && column.never_decreases && !options.pitch_m) {
      choice.x = c;
    } else {
      heights.push_back(c);
    }
  }
  if (z) heights = {*z};
  if (heights.empty()) {
    throw ThrownError({"no_numeric_column", file + ": no column of heights found; choose it with --z-column"});
  }
  choice.z = heights.front();
  if (heights.size() == 1) return choice;
  throw ThrownError({"ambiguous_columns",
                     fmt::format("{}: several columns may be the heights: {}; choose with --z-column (and --x-column)",
                                 file, reading::list_columns(layout))});
}

/// Returns the metres of one unit of a column; empty if the unit is unknown.
std::optional<double> scale_of(const Column& column, const ProfileOptions& options) {
  if (options.unit_m) return options.unit_m;
  const auto unit = parse_unit(column.name.unit, Dimension::Length);
  return unit && !column.name.unit.empty() ? std::optional<double>(unit.value().scale) : std::nullopt;
}

struct Columns {
  std::vector<double> x, z;
};

Columns read_columns(reading::OpenedFile file, const Choice& choice) {
  Columns columns;
  const reading::Dialect dialect = file.layout.dialect;
  const auto first = static_cast<unsigned>(file.layout.first_data_line);
  const std::string name = file.name;
  reading::ParsedLines lines(std::move(file.source));
  std::vector<std::string_view> cells;
  while (const char* const line = lines.next()) {
    if (lines.number() < first) continue;
    reading::split(line, dialect, cells);
    const auto number = [&](std::size_t column) {
      if (column >= cells.size()) return std::pair(CellKind::Text, kHole);
      const reading::Cell cell = reading::read_cell(cells[column], dialect.decimal_comma);
      return std::pair(cell.kind, cell.kind == CellKind::Number ? cell.value : kHole);
    };
    const auto [kind, height] = number(choice.z);
    const double place = choice.x ? number(*choice.x).second : 0.0;
    // A line of text is none of the profile; a place without a height is a hole.
    if (!std::isfinite(place) || kind == CellKind::Text || (!choice.x && kind == CellKind::Blank)) continue;
    if (choice.x) columns.x.push_back(place);
    columns.z.push_back(height);
    check_extent(columns.z.size(), 1, name);
  }
  return columns;
}

/// The columns as a profile, in metres where their units are known.
Profile made(Columns columns, const Choice& choice, const Layout& layout, const ProfileOptions& options,
             const std::string& file) {
  const std::optional<double> z_scale = scale_of(layout.columns[choice.z], options);
  for (double& z : columns.z) z *= z_scale.value_or(1.0);
  Profile profile;
  if (choice.x) {
    const double x_scale = *scale_of(layout.columns[*choice.x], options);
    for (double& x : columns.x) x *= x_scale;
    profile = value_or_throw(profile_of(std::move(columns.x), std::move(columns.z), file));
    profile.assumed.push_back("Positions along the track are " + reading::describe(layout, *choice.x) + ".");
  } else {
    profile.pitch_m = *options.pitch_m;
    profile.height = std::move(columns.z);
  }
  profile.assumed.push_back("Heights are " + reading::describe(layout, choice.z) + ".");
  profile.height_in_metres = z_scale.has_value();
  if (!z_scale) profile.assumed.emplace_back("The heights have no unit: their height is in that of the file.");
  return profile;
}

}  // namespace

Profile read_text_profile(const SurfaceFile& file, const ProfileOptions& options) {
  reading::OpenedFile opened = reading::open_file(std::move(*file.stream), file.name, {});
  const Layout layout = opened.layout;
  const Choice choice = choose(layout, options, file.name);
  if (!choice.x && !options.pitch_m) {
    throw ThrownError(
        {"no_pitch", file.name + ": a column of heights alone; state the distance between them: --pitch 1um"});
  }
  if (choice.x && !scale_of(layout.columns[*choice.x], options)) {
    throw ThrownError({"no_unit", fmt::format("{}: {} has no unit of length; state it with --unit um", file.name,
                                              reading::describe(layout, *choice.x))});
  }
  return made(read_columns(std::move(opened), choice), choice, layout, options, file.name);
}

}  // namespace slipfit::surface
