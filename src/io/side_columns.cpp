#include "io/columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/thrown_error.hpp"
#include "io/column_search.hpp"
#include "io/message.hpp"
#include "slipfit/core/units.hpp"

namespace slipfit::reading {
namespace {

std::optional<std::size_t> only_one(const std::vector<std::size_t>& found) {
  return found.size() == 1 ? std::optional(found.front()) : std::nullopt;
}

/// A column in the unit of its name, without one in SI.
std::optional<Channel> channel_in(const Layout& layout, std::size_t column, Dimension dimension) {
  const std::string& unit = layout.columns[column].name.unit;
  const auto scale = parse_unit(unit.empty() ? "1" : unit, unit.empty() ? Dimension::Dimensionless : dimension);
  if (!scale) return std::nullopt;
  return Channel{column, scale.value().scale, ForceQuantity::Force_N, {}};
}

/// In m/s. A speed of rotation needs the radius; a column without a unit is no speed that can be relied on.
std::optional<Channel> speed_channel(const Layout& layout, std::size_t column, const std::optional<double>& radius_m) {
  const std::string& unit = layout.columns[column].name.unit;
  if (const auto speed = parse_unit(unit, Dimension::Speed)) {
    return Channel{column, speed.value().scale, ForceQuantity::Force_N, {}};
  }
  const auto rotation = parse_unit(unit, Dimension::AngularSpeed);
  if (!rotation || !radius_m) return std::nullopt;
  return Channel{column, rotation.value().scale * *radius_m, ForceQuantity::Force_N, {}};
}

/// The first displacement whose unit is a length.
std::optional<Channel> choose_displacement(const Layout& layout, const Choice& choice) {
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    const Column& column = layout.columns[c];
    if (column.name.role != Role::Displacement || !column.is_numeric() || column.name.unit.empty()) continue;
    if (c == choice.force.column || (choice.time && c == choice.time->column)) continue;
    if (auto channel = channel_in(layout, c, Dimension::Length)) return channel;
  }
  return std::nullopt;
}

/// Returns the column of the normal force by its name, or nothing if none or several are possible.
std::optional<std::size_t> find_normal_force(const Layout& layout, std::optional<std::size_t> force) {
  return only_one(best_columns(layout, [&](const Column& column, std::size_t c) {
    if (!column.is_numeric() || (force && *force == c)) return 0;
    if (column.name.role == Role::NormalForce) return column.name.rank + 1;
    return column.name.role == Role::TangentialForce && column.name.rank == 1 && is_load(column.name) ? 1 : 0;
  }));
}

ThrownError side_unit_error(const Layout& layout, std::size_t column, const std::string& file,
                            const std::string& expected) {
  const std::string& unit = layout.columns[column].name.unit;
  return ThrownError({"unknown_unit", fmt::format("{}: the unit of {}: '{}' is not {}; leave the option out", file,
                                                  describe(layout, column), printable(unit), expected)});
}

std::optional<Channel> choose_normal_force(const Layout& layout, const ReadOptions& options, const Choice& choice,
                                           const std::string& file) {
  if (!options.normal_force_column) {
    const auto column = find_normal_force(layout, choice.force.column);
    return column ? channel_in(layout, *column, Dimension::Force) : std::nullopt;
  }
  const std::size_t column = find_column(layout, *options.normal_force_column, "--normal-force-column", file);
  auto channel = channel_in(layout, column, Dimension::Force);
  if (!channel) throw side_unit_error(layout, column, file, "a unit of force");
  return channel;
}

std::optional<Channel> choose_speed(const Layout& layout, const ReadOptions& options, const std::string& file) {
  if (!options.speed_column) {
    const auto column = only_one(best_columns(layout, [](const Column& candidate, std::size_t) {
      return candidate.name.role == Role::Speed && candidate.is_numeric() ? candidate.name.rank : 0;
    }));
    return column ? speed_channel(layout, *column, options.radius_m) : std::nullopt;
  }
  const std::size_t column = find_column(layout, *options.speed_column, "--speed-column", file);
  auto channel = speed_channel(layout, column, options.radius_m);
  if (!channel) throw side_unit_error(layout, column, file, "a unit of speed, nor of rotational speed with --radius");
  return channel;
}

std::optional<WhereFilter> choose_where(const Layout& layout, const ReadOptions& options, const std::string& file) {
  if (!options.where) return std::nullopt;
  const std::size_t column = find_column_of_any(layout, options.where->column, "--where COLUMN=VALUE", file);
  const double number = plain_number(options.where->value, layout.dialect.decimal_comma);
  return WhereFilter{column, options.where->value, std::isfinite(number) ? std::optional(number) : std::nullopt};
}

/// The first column of step numbers: further ones repeat it or count within it.
std::optional<std::size_t> find_steps(const Layout& layout) {
  const auto found = best_columns(layout, [](const Column& column, std::size_t) {
    return column.name.role == Role::Step && column.is_whole ? column.name.rank : 0;
  });
  return found.empty() ? std::nullopt : std::optional(found.front());
}

}  // namespace

std::vector<std::size_t> those_of_coefficient(const Layout& layout, std::vector<std::size_t> candidates) {
  constexpr double kTolerance = 0.02;  // filters and printed decimals
  constexpr std::size_t kFewest = 8;
  const auto coefficient = only_one(best_columns(layout, [](const Column& column, std::size_t) {
    return column.name.role == Role::FrictionCoefficient && column.is_numeric() ? column.name.rank : 0;
  }));
  const auto normal = find_normal_force(layout, std::nullopt);
  if (!coefficient || !normal) return candidates;
  const auto is_its_force = [&](std::size_t c) {
    std::size_t alike = 0;
    std::size_t compared = 0;
    for (std::size_t row = 0; row < layout.columns[c].values.size(); ++row) {
      const double mu = std::abs(layout.columns[*coefficient].values[row]);
      const double quotient = std::abs(layout.columns[c].values[row] / layout.columns[*normal].values[row]);
      if (!std::isfinite(quotient) || !std::isfinite(mu) || mu == 0.0) continue;
      ++compared;
      if (std::abs(quotient - mu) <= kTolerance * mu) ++alike;
    }
    return compared >= kFewest && 10 * alike >= 8 * compared;
  };
  std::vector<std::size_t> found;
  std::ranges::copy_if(candidates, std::back_inserter(found), is_its_force);
  return found.empty() ? candidates : found;
}

double radius_for_torque(const std::optional<double>& radius_m, const std::string& place) {
  if (radius_m) return *radius_m;
  throw ThrownError({"no_radius", place + " is a torque; give the distance of the contact from the axis with --radius, "
                                          "for example --radius 12mm"});
}

Choice with_side_columns(Choice choice, const Layout& layout, const ReadOptions& options, const std::string& file) {
  choice.normal_force = choose_normal_force(layout, options, choice, file);
  choice.speed = choose_speed(layout, options, file);
  choice.where = choose_where(layout, options, file);
  choice.displacement = choose_displacement(layout, choice);
  choice.step = find_steps(layout);
  return choice;
}

}  // namespace slipfit::reading
