#include "io/columns.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/counted.hpp"
#include "core/thrown_error.hpp"
#include "core/unit_text.hpp"
#include "core/word_list.hpp"
#include "io/message.hpp"
#include "io/read_options.hpp"
#include "slipfit/core/units.hpp"

namespace slipfit::reading {

namespace {

constexpr std::size_t kMostListed = 24;

template <class Matches>
std::vector<std::size_t> columns_where(const Layout& layout, const Matches& matches) {
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    if (matches(layout.columns[c].name)) found.push_back(c);
  }
  return found;
}

std::vector<std::size_t> columns_called(const Layout& layout, const std::string& wanted) {
  if (wanted.empty()) return {};
  auto found = columns_where(layout, [&](const ColumnName& name) { return name.text == wanted; });
  if (found.empty()) {
    found = columns_where(layout, [&](const ColumnName& name) {
      return lower(name.text) == lower(wanted) || lower(name.base) == lower(wanted);
    });
  }
  return found;
}

}  // namespace

std::string describe(const Layout& layout, std::size_t column) {
  const std::string& name = layout.columns[column].name.text;
  return name.empty() ? fmt::format("column {}", column + 1) : fmt::format("column {} '{}'", column + 1, name);
}

std::string list_columns(const Layout& layout) {
  const std::size_t count = layout.columns.size();
  const auto text_of = [&](std::size_t c) {
    const std::string& name = layout.columns[c].name.text;
    return name.empty() ? std::to_string(c + 1) : fmt::format("{} '{}'", c + 1, name);
  };
  return (count == 1 ? "the only column is " : "the columns are ") +
         listed(count, kMostListed, text_of, fmt::format(" and {} more", count - std::min(count, kMostListed))) +
         (layout.has_names ? "" : " (without names)");
}

namespace {

/// Finds a column with any contents. Error: unknown_column.
std::size_t find_column_of_any(const Layout& layout, const std::string& wanted, const std::string& option,
                               const std::string& file) {
  auto found = columns_called(layout, printable_utf8(wanted));
  const auto place = place_in_list(wanted, layout.columns.size());
  if (found.empty() && place) found = {*place};
  if (found.empty()) {
    throw ThrownError({"unknown_column", fmt::format("{}: no column '{}'; {}; choose one with {}", file,
                                                     printable_utf8(wanted), list_columns(layout), option)});
  }
  if (found.size() > 1) {
    throw ThrownError({"unknown_column", fmt::format("{}: several columns are called '{}'; {}; give the number with {}",
                                                     file, printable_utf8(wanted), list_columns(layout), option)});
  }
  return found.front();
}

}  // namespace

std::size_t find_column(const Layout& layout, const std::string& wanted, const std::string& option,
                        const std::string& file) {
  const std::size_t found = find_column_of_any(layout, wanted, option, file);
  if (layout.columns[found].may_be_numeric()) return found;
  throw ThrownError({"column_not_numeric", fmt::format("{}:{}: {} contains text, not numbers; choose another with {}",
                                                       file, layout.first_data_line, describe(layout, found), option)});
}

namespace {

/// The columns with the highest score above 0 (several where they tie).
template <class ScoreOf>
std::vector<std::size_t> best_columns(const Layout& layout, const ScoreOf& score_of) {
  std::vector<std::size_t> best;
  int highest = 1;
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    const int score = score_of(layout.columns[c], c);
    if (score < highest) continue;
    if (score > highest) best.clear();
    highest = score;
    best.push_back(c);
  }
  return best;
}

/// Finds the column of the time; empty if no column can be it. Error: ambiguous_time_column.
std::optional<std::size_t> find_time_column(const Layout& layout, const std::string& file) {
  auto found = best_columns(layout, [](const Column& column, std::size_t) {
    if (column.name.role != Role::Time || !column.may_be_numeric()) return 0;
    return column.name.rank + (column.never_decreases ? 8 : 0) +
           (column.name.unit.empty() && column.clocks == 0 ? 0 : 4);
  });
  const auto rises = [](const Column& column) {
    return column.name.role == Role::Unknown && column.is_numeric() && column.never_decreases;
  };
  const auto is_numeric = [](const Column& column) { return column.is_numeric(); };
  const bool is_alone = std::ranges::count_if(layout.columns, is_numeric) == 1;
  if (found.empty() && !is_alone) {
    // Monotonic columns are compared: a clock has even steps, and a column of integers with step one next to it
    // contains line numbers.
    found = best_columns(layout, [&](const Column& column, std::size_t) {
      const bool is_counter = column.is_whole && column.is_regular && column.median_step == 1.0;
      return !rises(column) ? 0 : is_counter ? 1 : column.is_regular ? 3 : 2;
    });
  }
  if (found.size() > 1) {
    throw ThrownError({"ambiguous_time_column",
                       fmt::format("{}: {} and {} may both be the time; {}; choose one with --time-column", file,
                                   describe(layout, found[0]), describe(layout, found[1]), list_columns(layout))});
  }
  return found.empty() ? std::nullopt : std::optional(found.front());
}

/// The arguments of `choose_columns`.
struct Request {
  const Layout& layout;
  const ReadOptions& options;
  const std::string& file;
  double speed_m_per_s = 0.0;  ///< 0: not known
};

ThrownError unit_error(const Request& request, std::size_t column, const std::string& cause,
                       const std::string& option) {
  return ThrownError({"unknown_unit", fmt::format("{}: the unit of {}: {}; give it with {}", request.file,
                                                  describe(request.layout, column), printable_utf8(cause), option)});
}

bool mentions(const std::string& name, std::initializer_list<std::string_view> words) {
  return std::ranges::any_of(words,
                             [text = lower(name)](std::string_view w) { return text.find(w) != std::string::npos; });
}

struct GuessedUnit {
  std::string_view unit;
  std::string_view why;
};

/// The shortest step of a date in days, 1.7 s: a clock in seconds would step by 20 microseconds for hours.
constexpr double kShortStep_d = 2e-5;

/// Computers stamp in whole milliseconds since some start, or in milliseconds, micro- or nanoseconds since 1970.
GuessedUnit guess_time_unit(const Column& column) {
  const bool is_stamp = mentions(column.name.base, {"stamp", "stempel", "tick"});
  const double start = std::abs(column.first);
  if (start >= 1e17) return {"ns", "of the size of nanoseconds since 1970"};
  if (start >= 1e14) return {"us", "of the size of microseconds since 1970"};
  if (start >= 1e11) return {"ms", "of the size of milliseconds since 1970"};
  const bool is_of_Excel = start >= 20000.0 && start <= 80000.0 && column.median_step < kShortStep_d;
  if (!column.is_whole && column.never_decreases && is_of_Excel) return {"d", "of the size of Excel's dates"};
  if (mentions(column.name.base, {"millis"})) return {"ms", "its name"};
  if (mentions(column.name.base, {"micros"})) return {"us", "its name"};
  if (is_stamp && column.is_whole && column.median_step > 1.0) return {"ms", "whole time stamps in steps above 1"};
  if (column.is_whole && column.is_regular && column.median_step == 1.0) {
    return {"s", "no unit is stated; if the column counts samples, give --sample-rate"};
  }
  return {"s", "no unit is given"};
}

/// The unit is that of the option, else that of the name, else a guess.
Channel time_channel(const Request& request, std::size_t column) {
  const Column& found = request.layout.columns[column];
  const std::string name = describe(request.layout, column);
  const auto& stated = request.options.time_unit;
  const GuessedUnit guess = guess_time_unit(found);
  const bool is_guess = !stated && found.name.unit.empty();
  const std::string unit = is_guess ? std::string(guess.unit) : stated.value_or(found.name.unit);
  Channel channel{column, 1.0, ForceQuantity::Force_N, fmt::format("Time is {}, a clock (h:min:s).", name)};
  if (found.clocks > found.numbers) {
    channel.is_clock = true;
    return channel;
  }
  const auto scale = parse_unit(unit, Dimension::Time);
  if (!scale) throw unit_error(request, column, scale.error().message, "--time-unit");
  channel.scale = scale.value();
  channel.is_clock = is_guess && guess.unit == "d";
  channel.is_unit_assumed = is_guess;
  channel.sentence =
      is_guess ? fmt::format("Time is {}, assumed to be in {} ({}).", name, unit, guess.why)
               : fmt::format("Time is {}, in {}{}.", name, printable_utf8(unit), stated ? " (as stated)" : "");
  return channel;
}

/// Returns the displacement that gives the time of a test at a known speed, t = x / V; empty without one that has a
/// unit.
std::optional<Channel> displacement_as_time(const Request& request) {
  const auto& columns = request.layout.columns;
  const auto way = std::ranges::find_if(columns, [](const Column& column) {
    return column.name.role == Role::Displacement && column.varies && !column.name.unit.empty();
  });
  if (way == columns.end() || !(request.speed_m_per_s > 0.0)) return std::nullopt;
  const auto scale = parse_unit(way->name.unit, Dimension::Length);
  if (!scale) return std::nullopt;
  std::vector<double> numbers;
  std::ranges::copy_if(way->values, std::back_inserter(numbers), [](double value) { return std::isfinite(value); });
  const double direction = numbers.back() < numbers.front() ? -1.0 : 1.0;
  const auto column = static_cast<std::size_t>(way - columns.begin());
  return Channel{column, direction * scale.value() / request.speed_m_per_s, ForceQuantity::Force_N,
                 fmt::format("Time is {} divided by the driving speed, t = x/V (the file has no time column).",
                             describe(request.layout, column))};
}

/// Nothing where the sampling rate is the clock.
std::optional<Channel> choose_time(const Request& request) {
  const auto& [layout, options, file, speed_m_per_s] = request;
  if (options.time_column) {
    return time_channel(request, find_column(layout, *options.time_column, "--time-column", file));
  }
  if (options.sample_rate_Hz) return std::nullopt;
  if (const auto column = find_time_column(layout, file)) return time_channel(request, *column);
  if (auto way = displacement_as_time(request)) return way;
  throw ThrownError(
      {"no_time_column", fmt::format("{}: no time column; {}; give the sampling rate with --sample-rate, or the "
                                     "column with --time-column",
                                     file, list_columns(layout))});
}

/// Warns of times that are evenly spaced at another rate than the stated one. A coarse clock is neither.
Warnings warn_of_rate(const Request& request) {
  constexpr double kTolerance = 0.05;
  const std::optional<double>& stated_Hz = request.options.sample_rate_Hz;
  if (!stated_Hz) return {};
  for (std::size_t c = 0; c < request.layout.columns.size(); ++c) {
    const Column& column = request.layout.columns[c];
    const Result<double> unit = parse_unit(column.name.unit, Dimension::Time);
    if (column.name.role != Role::Time || !unit || !column.is_regular) continue;
    const double rate_Hz = 1.0 / (column.median_step * unit.value());
    if (std::abs(rate_Hz - *stated_Hz) <= kTolerance * *stated_Hz) continue;
    return {{"sample_rate_differs",
             fmt::format("--sample-rate states {:.6g} samples per second, but the times in {} are those of {:.6g}; "
                         "leave out --sample-rate if they are right",
                         *stated_Hz, describe(request.layout, c), rate_Hz)}};
  }
  return {};
}

/// About a clock that is counted from the sampling rate.
std::string counted_clock_sentence(const Layout& layout, double sample_rate_Hz) {
  std::string sentence = fmt::format("Time is counted from 0 at {} samples per second (as stated).", sample_rate_Hz);
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    if (layout.columns[c].name.role == Role::Time)
      sentence += fmt::format(" The times in {} are not used.", describe(layout, c));
  }
  return sentence;
}

int score_of_normal_force(const Column& column) {
  if (!column.is_numeric()) return 0;
  if (column.name.role == Role::NormalForce) return column.name.rank + 1;
  return column.name.role == Role::TangentialForce && column.name.rank == 1 && is_load(column.name) ? 1 : 0;
}

/// Returns, of several possible columns of the tangential force, those whose quotient with the normal force is the
/// column of friction coefficients; all of them if that does not decide.
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

/// Candidates for the force, best first in rank; a "load" next to a friction coefficient is the normal load.
std::vector<std::size_t> force_candidates(const Layout& layout, std::optional<std::size_t> time,
                                          const std::optional<std::string>& force_scale) {
  const auto is_usable = [&](const Column& column, std::size_t c) {
    return column.may_be_numeric() && (!time || *time != c);
  };
  auto coefficients = best_columns(layout, [&](const Column& column, std::size_t c) {
    return is_usable(column, c) && column.name.role == Role::FrictionCoefficient ? column.name.rank : 0;
  });
  auto forces = best_columns(layout, [&](const Column& column, std::size_t c) {
    if (!is_usable(column, c) || column.name.role != Role::TangentialForce) return 0;
    return column.name.rank == 1 && !coefficients.empty() ? 0 : column.name.rank;
  });
  if (forces.size() > 1) forces = those_of_coefficient(layout, std::move(forces));
  if (!forces.empty()) return forces;
  if (!coefficients.empty()) return coefficients;
  auto torques = best_columns(layout, [&](const Column& column, std::size_t c) {
    return is_usable(column, c) && column.name.role == Role::Torque ? column.name.rank : 0;
  });
  if (!torques.empty()) return torques;
  if (force_scale) {
    const auto scale = parse_force_scale(*force_scale);
    const auto of_scale = scale ? read_unit(scale->unit) : std::nullopt;
    forces = best_columns(layout, [&](const Column& column, std::size_t c) {
      const auto unit = read_unit(column.name.unit);
      return is_usable(column, c) && unit && of_scale && unit->powers == of_scale->powers ? 1 : 0;
    });
    if (!forces.empty()) return forces;
  }
  return best_columns(layout, [&](const Column& column, std::size_t c) {
    if (!is_usable(column, c) || column.name.role != Role::Unknown || !column.is_numeric()) return 0;
    const bool is_counter = column.is_whole && column.is_regular;  // line numbers
    return is_counter ? 1 : column.varies ? 3 : 2;
  });
}

std::size_t choose_force(const Request& request, std::optional<std::size_t> time) {
  const auto& [layout, options, file, speed_m_per_s] = request;
  if (options.force_column) return find_column(layout, *options.force_column, "--force-column", file);
  auto candidates = force_candidates(layout, time, options.force_scale);
  const auto varies = [&](std::size_t c) { return request.layout.columns[c].varies; };
  if (std::ranges::count_if(candidates, varies) == 1) {
    candidates = {*std::ranges::find_if(candidates, varies)};
  }
  if (candidates.empty()) {
    throw ThrownError(
        {"no_force_column", fmt::format("{}: no column is a tangential force; {}; choose one with --force-column", file,
                                        list_columns(layout))});
  }
  if (candidates.size() > 1) {
    const std::string others = candidates.size() > 2 ? fmt::format(" (and {} more)", candidates.size() - 2) : "";
    throw ThrownError(
        {"ambiguous_force_column",
         fmt::format("{}: {} and {}{} may each be the force; {}; choose one with --force-column", file,
                     describe(layout, candidates[0]), describe(layout, candidates[1]), others, list_columns(layout))});
  }
  return candidates.front();
}

/// Returns the force from a column of volts or another quantity, by the stated force per unit. Without a unit in the
/// file it is that of the scale.
Channel scaled_channel(const Request& request, std::size_t column, const std::string& text) {
  const auto scale = parse_force_scale(text);
  const std::string described = describe(request.layout, column);
  const std::string& named = request.layout.columns[column].name.unit;
  const std::string unit = request.options.force_unit.value_or(named.empty() && scale ? scale->unit : named);
  const auto of_column = read_unit(unit);
  const auto of_scale = scale ? read_unit(scale->unit) : std::nullopt;
  const bool is_known = of_scale && of_column && of_scale->powers == of_column->powers;
  const bool is_same_text = scale && !of_scale && lower(scale->unit) == lower(unit);
  if (!is_known && !is_same_text) {
    throw unit_error(request, column, fmt::format("'{}' is not the unit of --force-scale '{}'", unit, text),
                     "--force-unit");
  }
  return Channel{
      column, (is_known ? of_column->factor : 1.0) * scale->N_per_SI, ForceQuantity::Force_N,
      fmt::format("Force is {}, in {}, at {} (as stated).", described, printable_utf8(unit), printable_utf8(text))};
}

/// A torque over the radius at which the contact lies. Error: no_radius.
Channel torque_channel(const Request& request, std::size_t column, const std::string& unit, double N_m) {
  const std::string described = describe(request.layout, column);
  const auto& radius_m = request.options.radius_m;
  if (!radius_m) {
    throw ThrownError({"no_radius", fmt::format("{}: {} is a torque; give the distance of the contact from the axis "
                                                "with --radius, in metres (0.012)",
                                                request.file, described)});
  }
  return Channel{column, N_m / *radius_m, ForceQuantity::Force_N,
                 fmt::format("Force is {}, a torque (unit {}), divided by the radius of {} m.", described,
                             printable_utf8(unit), *radius_m)};
}

/// Returns advice for a unit that is not a force.
std::string force_remedy(const std::string& unit) {
  const auto known = read_unit(unit);
  if (known && known->powers == kVolt) return "--force-scale '5 N/V' (newtons a volt of this sensor)";
  return fmt::format(
      "--force-unit, such as --force-unit N, or the newtons per unit of the column with --force-scale, such as "
      "--force-scale '5 N/{}'",
      unit);
}

Channel without_unit(const Request& request, std::size_t column) {
  const std::string described = describe(request.layout, column);
  const Role role = request.layout.columns[column].name.role;
  if (role == Role::Torque) return torque_channel(request, column, "N m, since none is given", 1.0);
  if (role == Role::FrictionCoefficient) {
    return Channel{column, 1.0, ForceQuantity::FrictionCoefficient,
                   fmt::format("Friction coefficient is {}.", described)};
  }
  return Channel{column, 1.0, ForceQuantity::Force_N,
                 fmt::format("Force is {}, assumed to be in N (no unit is stated).", described)};
}

/// The unit decides between force, torque and coefficient; without one the name does.
Channel force_channel(const Request& request, std::size_t column) {
  if (request.options.force_scale) return scaled_channel(request, column, *request.options.force_scale);
  const bool is_stated = request.options.force_unit.has_value();
  const std::string unit = is_stated ? *request.options.force_unit : request.layout.columns[column].name.unit;
  if (unit.empty()) return without_unit(request, column);
  const std::string described = describe(request.layout, column);
  const std::string in_unit = fmt::format("in {}{}", printable_utf8(unit), is_stated ? " (as stated)" : "");
  const auto as_force = parse_unit(unit, Dimension::Force);
  if (as_force) {
    return Channel{column, as_force.value(), ForceQuantity::Force_N,
                   fmt::format("Force is {}, {}.", described, in_unit)};
  }
  if (const auto torque = parse_unit(unit, Dimension::Torque)) {
    return torque_channel(request, column, unit, torque.value());
  }
  const auto as_number = parse_unit(unit, Dimension::Dimensionless);
  if (!as_number) throw unit_error(request, column, as_force.error().message, force_remedy(unit));
  return Channel{column, as_number.value(), ForceQuantity::FrictionCoefficient,
                 fmt::format("Friction coefficient is {}, {}.", described, in_unit)};
}

std::vector<std::string> layout_sentences(const Layout& layout) {
  std::vector<std::string> sentences;
  if (layout.skipped_lines > 0) {
    sentences.push_back(fmt::format("{} before the data {} skipped.", counted(layout.skipped_lines, "line"),
                                    layout.skipped_lines == 1 ? "was" : "were"));
  }
  if (layout.dialect.decimal_comma) sentences.emplace_back("The comma is the decimal sign.");
  if (!layout.has_names) sentences.emplace_back("The columns have no names.");
  return sentences;
}

/// A column in the unit of its name, without one in SI.
template <Dimension dimension>
std::optional<Channel> in_unit(const Layout& layout, std::size_t column, const ReadOptions& /*options*/) {
  const std::string& unit = layout.columns[column].name.unit;
  const auto scale = parse_unit(unit.empty() ? "1" : unit, unit.empty() ? Dimension::Dimensionless : dimension);
  if (!scale) return std::nullopt;
  return Channel{column, scale.value(), ForceQuantity::Force_N, {}};
}

/// In m/s. A speed of rotation needs the radius; a column without a unit is no speed that can be relied on.
std::optional<Channel> speed_channel(const Layout& layout, std::size_t column, const ReadOptions& options) {
  const std::string& unit = layout.columns[column].name.unit;
  if (const auto speed = parse_unit(unit, Dimension::Speed)) {
    return Channel{column, speed.value(), ForceQuantity::Force_N, {}};
  }
  const auto rotation = parse_unit(unit, Dimension::AngularSpeed);
  if (!rotation || !options.radius_m) return std::nullopt;
  return Channel{column, rotation.value() * *options.radius_m, ForceQuantity::Force_N, {}};
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

/// A column that was not selected is used if its name and unit are unambiguous, and is otherwise no reason to refuse a
/// file.
std::optional<Channel> choose_side(const SideRole& role, const Layout& layout, const ReadOptions& options,
                                   const Choice& choice, const std::string& file) {
  if (role.asked != nullptr && options.*role.asked) {
    const std::size_t column = find_column(layout, *(options.*role.asked), role.option, file);
    if (column == choice.force.column) {
      throw ThrownError(
          {"conflicting_options", fmt::format("{}: {} is the force and cannot be that of {}, too; {}", file,
                                              describe(layout, column), role.option, list_columns(layout))});
    }
    if (auto channel = role.in_SI(layout, column, options)) return channel;
    throw ThrownError({"unknown_unit", fmt::format("{}: the unit of {}: '{}' is not {}; leave the option out", file,
                                                   describe(layout, column),
                                                   printable_utf8(layout.columns[column].name.unit), role.expected)});
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

Choice choose_columns(const Layout& layout, const ReadOptions& options, double speed_m_per_s, const std::string& file) {
  if (options.time_column && options.sample_rate_Hz) {
    throw ThrownError(
        {"conflicting_options", file + ": both a time column and a sampling rate are given; leave out one of them"});
  }
  const Request request{layout, options, file, speed_m_per_s};
  Choice choice;
  choice.time = choose_time(request);
  const std::size_t column = choose_force(request, choice.time ? std::optional(choice.time->column) : std::nullopt);
  if (choice.time && choice.time->column == column) {
    throw ThrownError(
        {"conflicting_options", fmt::format("{}: {} cannot be both time and force; {}; choose two columns", file,
                                            describe(layout, column), list_columns(layout))});
  }
  choice.force = force_channel(request, column);
  choice.assumed = layout_sentences(layout);
  choice.assumed.push_back(choice.time ? choice.time->sentence
                                       : counted_clock_sentence(layout, *options.sample_rate_Hz));
  choice.assumed.push_back(choice.force.sentence);
  for (const SideRole& role : kSideRoles) choice.*role.channel = choose_side(role, layout, options, choice, file);
  choice.where = choose_where(layout, options, file);
  choice.warnings = warn_of_rate(request);
  return choice;
}

}  // namespace slipfit::reading
