#include "io/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/quantile.hpp"
#include "core/thrown_error.hpp"
#include "io/column_search.hpp"
#include "io/levels.hpp"
#include "slipfit/core/units.hpp"

namespace slipfit::reading {
namespace {

constexpr std::size_t kBlocks = 64;
constexpr double kTolerance = 0.05;       // of a stated value against a slope or a load cell's mean
constexpr double kSpeedTolerance = 0.01;  // of a stated speed against a column of speeds
constexpr double kClearlyOff = 2.0;       // standard deviations of the column
constexpr double kMostLoadScatter = 0.1;  // of the load, before its mean says little about the single slip

bool differ(double stated, const Level& measured, double tolerance) {
  const double bound = std::max(tolerance * stated, kClearlyOff * measured.standard_deviation);
  return std::abs(stated - measured.value) > bound;
}

/// The speed of the parts where a displacement moves (median of block slopes, without sign) with the error of that
/// median, if most of them move at one speed.
std::optional<Estimate> steady_speed_m_per_s(const Rows& rows) {
  std::vector<double> speeds = block_speeds_m_per_s(rows.time_s, rows.displacement_m, kBlocks);
  if (speeds.size() < 4) return std::nullopt;
  const double fast_m_per_s = quantile_of(speeds, 0.9);
  std::erase_if(speeds, [&](double v) { return !(v > 0.2 * fast_m_per_s); });  // standing, or about to start
  if (speeds.size() < 3) return std::nullopt;
  const double speed_m_per_s = quantile_of(speeds, 0.5);
  const auto alike =
      std::ranges::count_if(speeds, [&](double v) { return std::abs(v - speed_m_per_s) <= 0.2 * speed_m_per_s; });
  const bool is_steady = 10 * alike >= 6 * static_cast<std::ptrdiff_t>(speeds.size());
  if (!is_steady) return std::nullopt;
  std::vector<double> off;
  off.reserve(speeds.size());
  for (const double v : speeds) off.push_back(std::abs(v - speed_m_per_s));
  constexpr double kMedianToSe = 1.4826 * 1.2533;  // of a median of deviations to the error of a median
  const double se_m_per_s = kMedianToSe * quantile_of(off, 0.5) / std::sqrt(static_cast<double>(off.size()));
  return Estimate{speed_m_per_s, se_m_per_s, std::nullopt, {}};
}

/// Factors by which speeds are wrong if the unit is confused: mm and cm, min and s, m and mm, m/s and mm/min, mm/s and
/// m/min.
constexpr std::array kUnitFactors{10.0, 60.0, 1000.0, 6e4, 1e3 / 60.0};

/// "10mm/min" of a stated "10 mm/s" where the displacement moves at that; else the speed of the displacement.
std::string speed_to_state(const Conditions& stated, double moved_m_per_s) {
  const Result<UnitScale> unit = parse_unit(stated.speed_unit, Dimension::Speed);
  const double number = stated.speed_m_per_s / (unit ? unit.value().scale : 1.0);
  for (const char* const other : {"mm/min", "mm/s", "um/s", "cm/s", "cm/min", "m/min", "m/s"}) {
    const double m_per_s = number * parse_unit(other, Dimension::Speed).value().scale;
    if (std::abs(m_per_s / moved_m_per_s - 1.0) < kTolerance) return fmt::format("{:.6g}{}", number, other);
  }
  return fmt::format("{:.6g}m/s", moved_m_per_s);
}

/// A stated speed that a displacement contradicts by the factor of a mistaken unit.
std::optional<Error> mistaken_speed(const Conditions& stated, double moved_m_per_s, const std::string& column,
                                    const std::string& file) {
  const double stated_m_per_s = stated.speed_m_per_s;
  const double ratio = std::max(stated_m_per_s / moved_m_per_s, moved_m_per_s / stated_m_per_s);
  const auto is_near = [&](double factor) { return std::abs(ratio / factor - 1.0) < kTolerance; };
  if (std::none_of(kUnitFactors.begin(), kUnitFactors.end(), is_near)) return std::nullopt;
  return Error{"speed_contradicted",
               fmt::format("{}: the speed is {:.6g} m/s, but {} moves at {:.6g} m/s; the factor {:.4g} suggests "
                           "another unit; give --speed {}, or correct the unit in the name of that column",
                           file, stated_m_per_s, column, moved_m_per_s, ratio, speed_to_state(stated, moved_m_per_s))};
}

ThrownError no_speed(const Choice& choice, const Layout& layout, const std::string& file) {
  if (!choice.speed) {
    return ThrownError(
        {"no_speed",
         file + ": --speed is missing: give the driving speed, for example --speed 10mm/s (no column contains it)"});
  }
  return ThrownError({"speed_varies", fmt::format("{}: {} has no constant speed; read a part of it with --step N, "
                                                  "--rows A:B or --window T0:T1, or give the speed with --speed",
                                                  file, describe(layout, choice.speed->column))});
}

void state_normal_force(StatedConditions& stated, const Rows& rows, const Choice& choice, const Layout& layout) {
  const auto level = level_of(rows.normal_force_N);
  if (!level) return;
  const std::string name = describe(layout, choice.normal_force->column);
  if (const auto& given = stated.conditions.normal_force_N) {
    if (!differ(*given, *level, kTolerance)) return;
    stated.warnings.push_back(
        {"normal_force_differs",
         fmt::format("the stated normal force is {:.6g} N, but {} contains {:.6g} N; the stated one is used", *given,
                     name, level->value)});
    return;
  }
  stated.conditions.normal_force_N = level->value;
  stated.assumed.push_back(fmt::format("Normal force is {}: {:.6g} N, standard deviation {:.2g} N.", name, level->value,
                                       level->standard_deviation));
  if (level->standard_deviation > kMostLoadScatter * level->value || !level->is_steady) {
    stated.warnings.push_back(
        {"normal_force_varies", fmt::format("{} varies by more than a tenth of its median of {:.6g} N, which is used "
                                            "throughout; read a part with a constant load",
                                            name, level->value)});
  }
}

}  // namespace

std::optional<Warning> compare_speed(double stated_m_per_s, double moved_m_per_s, const std::string& what) {
  const double off_m_per_s = std::abs(moved_m_per_s - stated_m_per_s);
  if (!std::isfinite(off_m_per_s) || off_m_per_s <= kTolerance * stated_m_per_s) return std::nullopt;
  return Warning{
      "speed_differs_from_displacement",
      fmt::format("the stated speed is {:.6g} m/s, but {} moves at {:.6g} m/s", stated_m_per_s, what, moved_m_per_s)};
}

StatedConditions state_conditions(const Rows& rows, const Choice& choice, const Layout& layout,
                                  const Conditions& conditions, const std::string& file) {
  StatedConditions stated{conditions, {}, {}, {}};
  double& speed_m_per_s = stated.conditions.speed_m_per_s;
  const auto measured = level_of(rows.speed_m_per_s);
  const bool is_wanted = std::exchange(stated.conditions.speed_is_known, true);
  if (speed_m_per_s == 0.0 && !(measured && measured->is_steady)) {
    if (is_wanted) throw no_speed(choice, layout, file);
    speed_m_per_s = 1.0;
    stated.conditions.speed_is_known = false;
  } else if (speed_m_per_s == 0.0) {
    speed_m_per_s = measured->value;
    stated.assumed.push_back(fmt::format("Speed is {}: {:.6g} m/s, standard deviation {:.2g} m/s.",
                                         describe(layout, choice.speed->column), speed_m_per_s,
                                         measured->standard_deviation));
  } else if (measured && differ(speed_m_per_s, *measured, kSpeedTolerance)) {
    stated.warnings.push_back(
        {"speed_differs", fmt::format("the stated speed is {:.6g} m/s, but {} contains {:.6g} m/s; the stated one is "
                                      "used, and stiffness and spacing depend on it",
                                      speed_m_per_s, describe(layout, choice.speed->column), measured->value)});
  }
  if (choice.displacement && !rows.displacement_m.empty() && stated.conditions.speed_is_known) {
    if (auto moved = steady_speed_m_per_s(rows)) {
      const std::string name = describe(layout, choice.displacement->column);
      if (auto error = mistaken_speed(stated.conditions, *moved->value, name, file))
        throw ThrownError(*std::move(error));
      if (auto warning = compare_speed(speed_m_per_s, *moved->value, name)) stated.warnings.push_back(*warning);
      stated.moved_m_per_s = std::move(moved);
    }
  }
  if (choice.normal_force) state_normal_force(stated, rows, choice, layout);
  return stated;
}

}  // namespace slipfit::reading
