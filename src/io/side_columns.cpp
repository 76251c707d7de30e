#include "io/columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "core/thrown_error.hpp"
#include "io/column_search.hpp"
#include "io/message.hpp"
#include "slipfit/core/units.hpp"

namespace slipfit::reading {
namespace {

int score_of_normal_force(const Column& column) {
  if (!column.is_numeric()) return 0;
  if (column.name.role == Role::NormalForce) return column.name.rank + 1;
  return column.name.role == Role::TangentialForce && column.name.rank == 1 && is_load(column.name) ? 1 : 0;
}

/// A column in the unit of its name, without one in SI.
template <Dimension dimension>
std::optional<Channel> in_unit(const Layout& layout, std::size_t column, const ReadOptions& /*options*/) {
  const std::string& unit = layout.columns[column].name.unit;
  const auto scale = parse_unit(unit.empty() ? "1" : unit, unit.empty() ? Dimension::Dimensionless : dimension);
  if (!scale) return std::nullopt;
  return Channel{column, scale.value().scale, ForceQuantity::Force_N, {}};
}

/// In m/s. A speed of rotation needs the radius; a column without a unit is no speed that can be relied on.
std::optional<Channel> speed_channel(const Layout& layout, std::size_t column, const ReadOptions& options) {
  const std::string& unit = layout.columns[column].name.unit;
  if (const auto speed = parse_unit(unit, Dimension::Speed)) {
    return Channel{column, speed.value().scale, ForceQuantity::Force_N, {}};
  }
  const auto rotation = parse_unit(unit, Dimension::AngularSpeed);
  if (!rotation || !options.radius_m) return std::nullopt;
  return Channel{column, rotation.value().scale * *options.radius_m, ForceQuantity::Force_N, {}};
}

/// How a column besides time and force is found.
struct SideRole {
  std::optional<Channel> Choice::*channel = nullptr;
  /// How well a column fits the role; 0: not at all.
  int (*score)(const Column&) = nullptr;
  std::optional<Channel> (*in_SI)(const Layout&, std::size_t, const ReadOptions&) = nullptr;
  bool takes_first = false;  ///< of several that fit alike; else none
  std::optional<std::string> ReadOptions::*asked = nullptr;
  const char* option = "";
  const char* expected = "";  ///< of the unit
};

const std::array kSideRoles = std::to_array<SideRole>(
    {{&Choice::normal_force, score_of_normal_force, in_unit<Dimension::Force>, false, &ReadOptions::normal_force_column,
      "--normal-force-column", "a unit of force"},
     {&Choice::speed,
      [](const Column& column) {
        return column.name.role == Role::Speed && column.is_numeric() ? column.name.rank : 0;
      },
      speed_channel, false, &ReadOptions::speed_column, "--speed-column",
      "a unit of speed, nor of rotational speed with --radius"},
     {&Choice::displacement,
      [](const Column& column) {
        const bool fits = column.name.role == Role::Displacement && column.is_numeric() && !column.name.unit.empty();
        return fits && parse_unit(column.name.unit, Dimension::Length) ? 1 : 0;
      },
      in_unit<Dimension::Length>, true},
     // Further columns of step numbers repeat the first or count within it.
     {&Choice::step,
      [](const Column& column) { return column.name.role == Role::Step && column.is_whole ? column.name.rank : 0; },
      [](const Layout&, std::size_t column, const ReadOptions&) {
        return std::optional(Channel{column, 1.0, ForceQuantity::Force_N, {}});
      },
      true}});

std::optional<Channel> choose(const SideRole& role, const Layout& layout, const ReadOptions& options,
                              const Choice& choice, const std::string& file) {
  if (role.asked != nullptr && options.*role.asked) {
    const std::size_t column = find_column(layout, *(options.*role.asked), role.option, file);
    if (auto channel = role.in_SI(layout, column, options)) return channel;
    throw ThrownError({"unknown_unit", fmt::format("{}: the unit of {}: '{}' is not {}; leave the option out", file,
                                                   describe(layout, column),
                                                   printable(layout.columns[column].name.unit), role.expected)});
  }
  const auto found = best_columns(layout, [&](const Column& column, std::size_t c) {
    const bool is_taken = c == choice.force.column || (choice.time && c == choice.time->column);
    return is_taken ? 0 : role.score(column);
  });
  const bool is_clear = found.size() == 1 || (role.takes_first && !found.empty());
  return is_clear ? role.in_SI(layout, found.front(), options) : std::nullopt;
}

std::optional<WhereFilter> choose_where(const Layout& layout, const ReadOptions& options, const std::string& file) {
  if (!options.where) return std::nullopt;
  const std::size_t column = find_column_of_any(layout, options.where->column, "--where COLUMN=VALUE", file);
  const double number = plain_number(options.where->value, layout.dialect.decimal_comma);
  return WhereFilter{column, options.where->value, std::isfinite(number) ? std::optional(number) : std::nullopt};
}

}  // namespace

std::vector<std::size_t> those_of_coefficient(const Layout& layout, std::vector<std::size_t> candidates) {
  constexpr double kTolerance = 0.02;  // filters and printed decimals
  constexpr std::size_t kFewest = 8;
  const auto coefficients = best_columns(layout, [](const Column& column, std::size_t) {
    return column.name.role == Role::FrictionCoefficient && column.is_numeric() ? column.name.rank : 0;
  });
  const auto normals =
      best_columns(layout, [](const Column& column, std::size_t) { return score_of_normal_force(column); });
  if (coefficients.size() != 1 || normals.size() != 1) return candidates;
  const std::vector<double>& coefficient = layout.columns[coefficients.front()].values;
  const std::vector<double>& normal = layout.columns[normals.front()].values;
  const auto is_its_force = [&](std::size_t c) {
    std::size_t alike = 0;
    std::size_t compared = 0;
    for (std::size_t row = 0; row < layout.columns[c].values.size(); ++row) {
      const double mu = std::abs(coefficient[row]);
      const double quotient = std::abs(layout.columns[c].values[row] / normal[row]);
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
  for (const SideRole& role : kSideRoles) choice.*role.channel = choose(role, layout, options, choice, file);
  choice.where = choose_where(layout, options, file);
  return choice;
}

}  // namespace slipfit::reading
