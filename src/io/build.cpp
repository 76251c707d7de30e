#include "io/build.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/clock_step.hpp"
#include "core/statistics.hpp"
#include "core/thrown_error.hpp"
#include "io/columns.hpp"
#include "io/steps.hpp"
#include "io/strokes.hpp"
#include "slipfit/core/units.hpp"

namespace slipfit::reading {

namespace {

/// Sums of the squares and cubes of changes.
struct Moments {
  double count = 0.0, square = 0.0, cube = 0.0;

  [[nodiscard]] double skewness_without(const Moments& part) const {
    const double mean_square = (square - part.square) / (count - part.count);
    const double mean_cube = (cube - part.cube) / (count - part.count);
    return mean_square > 0.0 ? mean_cube / std::pow(mean_square, 1.5) : 0.0;
  }
};

/// The number of parts of the trace in which changes over `width` samples are compared.
constexpr std::size_t kParts = 16;
std::array<Moments, kParts> moments_of_changes(std::span<const double> force, std::size_t width) {
  std::array<Moments, kParts> parts{};
  for (std::size_t i = 0; i + width < force.size(); ++i) {
    const double change = force[i + width] - force[i];
    Moments& part = parts[i * kParts / force.size()];
    part.count += 1.0;
    part.square += change * change;
    part.cube += change * change * change;
  }
  return parts;
}

std::size_t count_negative(std::span<const double> force) {
  return static_cast<std::size_t>(std::ranges::count_if(force, [](double f) { return f < 0.0; }));
}

/// The direction in which the force repeatedly changes much faster than in the other.
enum class SuddenChanges { None, Falls, Rises };

/// Returns the direction of sudden changes, by the skewness of the changes over some time: far from 0 with one sign,
/// whichever sixteenth of the trace is left out.
SuddenChanges sudden_changes(std::span<const double> force) {
  constexpr double kSkewness = 0.3;           // -0.3 for cycles near the limit of stick-slip, 0 for waves and noise
  constexpr std::size_t kLeastChanges = 512;  // in the trace, one after the other: that of noise is below 0.2
  for (std::size_t width = 1; width * kLeastChanges <= force.size(); width *= 2) {
    const std::array<Moments, kParts> parts = moments_of_changes(force, width);
    Moments all;
    for (const Moments& part : parts) {
      all.count += part.count;
      all.square += part.square;
      all.cube += part.cube;
    }
    const auto falls = [&all](const Moments& part) { return all.skewness_without(part) < -kSkewness; };
    const auto rises = [&all](const Moments& part) { return all.skewness_without(part) > kSkewness; };
    if (std::ranges::all_of(parts, falls)) return SuddenChanges::Falls;
    if (std::ranges::all_of(parts, rises)) return SuddenChanges::Rises;
  }
  return SuddenChanges::None;
}

Motion motion_of(const Part& part) {
  return {part.rows.force, part.rows.displacement_m};
}

constexpr double kStatedTolerance = 0.05;  // of a stated value against a slope or a load cell's mean
constexpr double kSpeedTolerance = 0.01;   // of a stated speed against a column of speeds
constexpr double kClearlyOff = 2.0;        // standard deviations of the column
constexpr double kMostLoadScatter = 0.1;   // of the load, before its mean says little about the single slip

bool differ(double stated, const Level& measured, double tolerance) {
  const double bound = std::max(tolerance * stated, kClearlyOff * measured.standard_deviation);
  return std::abs(stated - measured.value) > bound;
}

/// The speed of the parts where a displacement moves (median of block slopes, without sign) with the error of that
/// median, if most of them move at one speed.
std::optional<Estimate> steady_speed_m_per_s(const Rows& rows) {
  constexpr std::size_t kBlocks = 64;
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
  const Result<double> unit = parse_unit(stated.speed_unit, Dimension::Speed);
  const double number = stated.speed_m_per_s / (unit ? unit.value() : 1.0);
  for (const char* const other : {"mm/min", "mm/s", "um/s", "cm/s", "cm/min", "m/min", "m/s"}) {
    const double m_per_s = number * parse_unit(other, Dimension::Speed).value();
    if (std::abs(m_per_s / moved_m_per_s - 1.0) < kStatedTolerance) return fmt::format("{:.6g}{}", number, other);
  }
  return fmt::format("{:.6g}m/s", moved_m_per_s);
}

/// Error: speed_contradicted, where a displacement contradicts the stated speed by the factor of a mistaken unit.
void check_unit_of_speed(const Conditions& stated, double moved_m_per_s, const std::string& column,
                         const std::string& file) {
  const double stated_m_per_s = stated.speed_m_per_s;
  const double ratio = std::max(stated_m_per_s / moved_m_per_s, moved_m_per_s / stated_m_per_s);
  const auto is_near = [&](double factor) { return std::abs(ratio / factor - 1.0) < kStatedTolerance; };
  if (std::none_of(kUnitFactors.begin(), kUnitFactors.end(), is_near)) return;
  throw ThrownError(
      {"speed_contradicted",
       fmt::format("{}: the speed is {:.6g} m/s, but {} moves at {:.6g} m/s; the factor {:.4g} suggests another unit; "
                   "give --speed {}, or correct the unit in the name of that column",
                   file, stated_m_per_s, column, moved_m_per_s, ratio, speed_to_state(stated, moved_m_per_s))});
}

ThrownError no_speed(const OpenedFile& file) {
  if (!file.choice.speed) {
    return ThrownError({"no_speed", file.name + ": --speed is missing: give the driving speed, for example --speed "
                                                "10mm/s (no column contains it)"});
  }
  return ThrownError({"speed_varies", fmt::format("{}: {} has no constant speed; read a part of it with --step N, "
                                                  "--rows A:B or --window T0:T1, or give the speed with --speed",
                                                  file.name, describe(file.layout, file.choice.speed->column))});
}

/// Warns if a displacement moves at another speed than the stated one. `what` describes the displacement.
void compare_speed(Part& part, double moved_m_per_s, const std::string& what) {
  if (!part.conditions.speed_is_known) return;
  const double stated_m_per_s = part.conditions.speed_m_per_s;
  const double off_m_per_s = std::abs(moved_m_per_s - stated_m_per_s);
  if (!std::isfinite(off_m_per_s) || off_m_per_s <= kStatedTolerance * stated_m_per_s) return;
  part.provenance.warnings.push_back(
      {"speed_differs_from_displacement",
       fmt::format("the stated speed is {:.6g} m/s, but {} moves at {:.6g} m/s", stated_m_per_s, what, moved_m_per_s)});
}

/// The stated speed takes precedence over a column. Errors: no_speed, speed_varies.
void state_speed(Part& part, const OpenedFile& file) {
  double& speed_m_per_s = part.conditions.speed_m_per_s;
  const auto measured = level_of(part.rows.speed_m_per_s);
  const bool is_wanted = std::exchange(part.conditions.speed_is_known, true);
  if (speed_m_per_s == 0.0 && !(measured && measured->is_steady)) {
    if (is_wanted) throw no_speed(file);
    speed_m_per_s = 1.0;
    part.conditions.speed_is_known = false;
  } else if (speed_m_per_s == 0.0) {
    speed_m_per_s = measured->value;
    part.assume(fmt::format("Speed is {}: {:.6g} m/s, standard deviation {:.2g} m/s.",
                            describe(file.layout, file.choice.speed->column), speed_m_per_s,
                            measured->standard_deviation));
  } else if (measured && differ(speed_m_per_s, *measured, kSpeedTolerance)) {
    part.provenance.warnings.push_back(
        {"speed_differs",
         fmt::format("the stated speed is {:.6g} m/s, but {} contains {:.6g} m/s; the stated one is used, and "
                     "stiffness and spacing depend on it",
                     speed_m_per_s, describe(file.layout, file.choice.speed->column), measured->value)});
  }
}

/// Warns if a displacement that goes one way does not move at one speed.
void warn_of_changing_speed(Part& part, const std::string& what) {
  constexpr std::size_t kBlocks = 16;
  const std::vector<double>& places_m = part.rows.displacement_m;
  const std::vector<double> speeds = block_speeds_m_per_s(part.rows.time_s, places_m, kBlocks);
  const auto [least, most] = std::ranges::minmax_element(places_m);
  const bool goes_one_way = std::abs(places_m.back() - places_m.front()) > 0.9 * (*most - *least);
  if (speeds.size() < kBlocks / 2 || !goes_one_way) return;
  const double slow = quantile_of(speeds, 0.25);
  const double fast = quantile_of(speeds, 0.75);
  if (!(slow > 0.0 && fast > 1.2 * slow)) return;
  part.provenance.warnings.push_back(
      {"speed_differs_from_displacement",
       fmt::format(
           "the stated speed is {:.6g} m/s, but {} moves at {:.3g} to {:.3g} m/s in the middle half of the time: "
           "read parts of one speed with --window T0:T1",
           part.conditions.speed_m_per_s, what, slow, fast)});
}

/// Error: speed_contradicted.
void compare_with_displacement(Part& part, const OpenedFile& file) {
  if (part.rows.displacement_m.empty() || !part.conditions.speed_is_known) return;
  auto moved = steady_speed_m_per_s(part.rows);
  const std::string name = describe(file.layout, file.choice.displacement->column);
  if (!moved) {
    warn_of_changing_speed(part, name);
    return;
  }
  check_unit_of_speed(part.conditions, *moved->value, name, file.name);
  compare_speed(part, *moved->value, name);
  part.provenance.moved_m_per_s = std::move(moved);
}

/// The stated normal force takes precedence over a column.
void state_normal_force(Part& part, const OpenedFile& file) {
  const auto level = level_of(part.rows.normal_force_N);
  if (!level) return;
  const std::string name = describe(file.layout, file.choice.normal_force->column);
  Warnings& warnings = part.provenance.warnings;
  if (const auto& given = part.conditions.normal_force_N) {
    if (!differ(*given, *level, kStatedTolerance)) return;
    warnings.push_back(
        {"normal_force_differs",
         fmt::format("the stated normal force is {:.6g} N, but {} contains {:.6g} N; the stated one is used", *given,
                     name, level->value)});
    return;
  }
  part.conditions.normal_force_N = level->value;
  part.assume(fmt::format("Normal force is {}: {:.6g} N, standard deviation {:.2g} N.", name, level->value,
                          level->standard_deviation));
  if (level->standard_deviation > kMostLoadScatter * level->value || !level->is_steady) {
    warnings.push_back(
        {"normal_force_varies", fmt::format("{} varies by more than a tenth of its median of {:.6g} N, which is used "
                                            "throughout; read a part with a constant load",
                                            name, level->value)});
  }
}

/// Normal force and zero: from what the column says to a force.
void interpret_force(Part& part, ForceQuantity column) {
  Conditions& conditions = part.conditions;
  conditions.quantity = column;
  if (column == ForceQuantity::FrictionCoefficient && conditions.normal_force_N) {
    for (double& value : part.rows.force) value *= *conditions.normal_force_N;
    conditions.quantity = ForceQuantity::Force_N;
    part.assume(
        fmt::format("Force is the friction coefficient times the normal force of {} N.", *conditions.normal_force_N));
  }
  if (!conditions.zero_force_N) return;
  if (conditions.quantity == ForceQuantity::Force_N) {
    for (double& value : part.rows.force) value -= *conditions.zero_force_N;
    return;
  }
  part.provenance.warnings.push_back(
      {"zero_force_ignored",
       "a zero force in newtons cannot be subtracted from a friction coefficient without the normal force"});
}

/// Replaces time stamps that are a coarsely rounded even clock by that clock.
void restore_clock(Part& part) {
  std::vector<double>& time_s = part.rows.time_s;
  const std::optional<RoundedClock> clock = rounded_clock(time_s);
  if (!clock) return;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    time_s[i] = clock->begin_s + clock->step_s * static_cast<double>(i);
  }
  part.assume(fmt::format("The times are rounded to {:.4g} s from an even clock: one sample every {:.6g} s.",
                          clock->rounding_s, clock->step_s));
}

/// Forces in newtons, and what file and columns say of them. Errors: those of describe_part and of speeds.
Part interpret(Part part, const OpenedFile& file, const Conditions& conditions) {
  part.conditions = conditions;
  describe_part(part, file);
  state_speed(part, file);
  compare_with_displacement(part, file);
  state_normal_force(part, file);
  interpret_force(part, file.choice.force.quantity);
  restore_clock(part);
  return part;
}

void turn_sign(Part& part, const char* reason) {
  for (double& force : part.rows.force) force = -force;
  part.assume(reason);
}

/// A force that is negative throughout has the other sign, unless an unknown zero has made it negative: friction rises
/// slowly and falls suddenly. One that is negative for the most part has it where that shows.
void settle_sign(Part& part) {
  const std::vector<double>& force = part.rows.force;
  if (2 * count_negative(force) <= force.size()) return;
  const SuddenChanges changes = sudden_changes(force);
  if (!is_negative_throughout(force)) {
    const bool is_turned = changes == SuddenChanges::Rises && find_strokes(motion_of(part)).empty();
    if (is_turned) turn_sign(part, "The force is mostly negative and rises suddenly: its sign was reversed.");
  } else if (part.conditions.zero_force_N || changes != SuddenChanges::Falls) {
    turn_sign(part, "The force is negative throughout: its sign was reversed.");
  } else {
    part.assume(
        "The force is negative throughout, but it rises slowly and falls suddenly as friction does: its sign was kept, "
        "so the zero of the sensor is not at zero force.");
  }
}

Recording create(Part part, const std::string& file) {
  auto recording = Recording::create(std::move(part.rows.time_s), std::move(part.rows.force), part.conditions,
                                     std::move(part.provenance), std::move(part.rows.normal_force_N),
                                     std::move(part.rows.displacement_m));
  if (!recording) throw ThrownError({recording.error().code, file + ": " + recording.error().message});
  return std::move(recording).value();
}

/// Returns the samples at nearly constant speed if a displacement is known: a crank turns slowly at its ends.
SampleRange at_full_speed(const Rows& part, const Stroke& stroke) {
  constexpr std::size_t kBlocks = 32;
  constexpr double kFull = 0.9;
  if (part.displacement_m.empty() || stroke.size() < 2 * kBlocks) return {stroke.begin, stroke.end};
  const std::vector<double> speeds =
      block_speeds_m_per_s(stroke.of(part.time_s), stroke.of(part.displacement_m), kBlocks);
  const double full = kFull * quantile_of(speeds, 0.9);
  const auto is_full = [full](double speed) { return speed >= full; };
  const auto first = std::ranges::find_if(speeds, is_full);
  const auto last = std::find_if(speeds.rbegin(), speeds.rend(), is_full);
  if (first == speeds.end()) return {stroke.begin, stroke.end};
  const std::size_t step = stroke.size() / kBlocks;
  return {stroke.begin + step * static_cast<std::size_t>(first - speeds.begin()),
          std::min(stroke.end, stroke.begin + step * (1 + static_cast<std::size_t>(speeds.rend() - last)))};
}

/// The speed of the displacement over what is kept of a stroke. Empty where no displacement is known.
std::optional<double> moved_m_per_s(const Rows& part, const SampleRange& kept) {
  if (part.displacement_m.empty() || kept.size() < 2) return std::nullopt;
  const double moved_m = std::abs(part.displacement_m[kept.end - 1] - part.displacement_m[kept.begin]);
  return moved_m / (part.time_s[kept.end - 1] - part.time_s[kept.begin]);
}

NamedRecording record(const Part& part, const Stroke& stroke, std::size_t number, const std::string& file) {
  const SampleRange kept = at_full_speed(part.rows, stroke);
  const char sign = stroke.is_positive ? '+' : '-';
  Part own = part;
  own.rows.cut(kept);
  for (double& force : own.rows.force) force = stroke.is_positive ? force : -force;
  own.assume(
      fmt::format("Stroke {} is {:.6g} to {:.6g} s, without the ends at which the force reverses; its force has the "
                  "sign {} in the file.",
                  number, own.rows.time_s.front(), own.rows.time_s.back(), sign));
  const auto moved = moved_m_per_s(part.rows, kept);
  if (moved) compare_speed(own, *moved, "in this stroke the displacement");
  return {fmt::format("stroke {} ({})", number, sign), create(std::move(own), file)};
}

ThrownError no_long_stroke(const std::string& file) {
  return ThrownError({"no_strokes", file + ": no stroke of this sign is longer than the reversal of the force; use "
                                           "longer strokes, or a part of one with --window"});
}

/// The force at which the direction reverses: zero where the user states it, else midway between both directions.
double force_at_reversal(const Part& part, const std::vector<Stroke>& strokes) {
  if (part.conditions.zero_force_N) return 0.0;
  std::vector<double> positive;
  std::vector<double> negative;
  for (const Stroke& stroke : strokes) {
    const auto forces = stroke.of(part.rows.force);
    std::vector<double>& side = stroke.is_positive ? positive : negative;
    side.insert(side.end(), forces.begin(), forces.end());
  }
  if (positive.empty() || negative.empty()) return 0.0;
  return 0.5 * (quantile_of(std::move(positive), 0.5) + quantile_of(std::move(negative), 0.5));
}

/// All strokes of a reciprocating test as one recording: those backward turned, without the ends in which the force
/// reverses. The clock keeps its gaps there.
Part pooled(Part part, std::vector<Stroke> strokes, const std::string& file) {
  std::erase_if(strokes, [](const Stroke& stroke) { return stroke.size() == 0; });
  if (strokes.empty()) throw no_long_stroke(file);
  const double reversal = force_at_reversal(part, strokes);
  std::vector<std::size_t> kept;
  std::vector<double> speeds_m_per_s;
  for (const Stroke& stroke : strokes) {
    const SampleRange range = at_full_speed(part.rows, stroke);
    for (std::size_t i = range.begin; i < range.end; ++i) {
      if (!stroke.is_positive) part.rows.force[i] = 2.0 * reversal - part.rows.force[i];
      kept.push_back(i);
    }
    if (const auto moved = moved_m_per_s(part.rows, range)) speeds_m_per_s.push_back(*moved);
  }
  part.rows.keep(kept);
  for (double& force : part.rows.force) force -= reversal;
  part.provenance.strokes = strokes.size();
  part.provenance.warnings.push_back(
      {"strokes_pooled",
       fmt::format("the drive reverses (a reciprocating test): {} strokes were analysed together, with "
                   "the force of those backward turned and without the ends of each",
                   strokes.size())});
  if (!speeds_m_per_s.empty()) {
    compare_speed(part, quantile_of(std::move(speeds_m_per_s), 0.5), "in the strokes the displacement");
  }
  return part;
}

}  // namespace

bool is_negative_throughout(std::span<const double> force) {
  return 10 * count_negative(force) >= 9 * force.size();
}

Recording build_recording(Part part, const OpenedFile& file, const Conditions& conditions) {
  Part one = interpret(std::move(part), file, conditions);
  settle_sign(one);
  std::vector<Stroke> strokes = find_strokes(motion_of(one));
  if (!strokes.empty()) one = pooled(std::move(one), std::move(strokes), file.name);
  return create(std::move(one), file.name);
}

std::vector<NamedRecording> build_strokes(Part part, const OpenedFile& file, const Conditions& conditions) {
  const Part all = interpret(std::move(part), file, conditions);
  const std::vector<Stroke> strokes = take_strokes(motion_of(all));
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const bool is_wanted = file.options.pieces == Pieces::Strokes ||
                           strokes[i].is_positive == (file.options.pieces == Pieces::PositiveStrokes);
    if (is_wanted && strokes[i].begin < strokes[i].end) wanted.push_back(i);
  }
  if (wanted.empty()) {
    if (!strokes.empty()) throw no_long_stroke(file.name);
    throw ThrownError({"no_strokes", file.name + ": the sign of the force does not alternate as in a reciprocating "
                                                 "test; leave out --strokes"});
  }
  // Of both directions a pair at a time, so that each is there as often as the other.
  const std::size_t group = file.options.pieces == Pieces::Strokes ? 2 : 1;
  const std::size_t groups = (wanted.size() + group - 1) / group;
  const std::size_t taken = std::min(groups, kMostPieces / group);
  std::vector<NamedRecording> recordings;
  for (std::size_t g = 0; g < taken; ++g) {
    const std::size_t first = group * (g * groups / taken);
    for (std::size_t i = first; i < std::min(first + group, wanted.size()); ++i) {
      recordings.push_back(record(all, strokes[wanted[i]], wanted[i] + 1, file.name));
    }
  }
  return recordings;
}

}  // namespace slipfit::reading
