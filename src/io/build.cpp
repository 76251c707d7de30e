#include "io/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/clock_step.hpp"
#include "core/quantile.hpp"
#include "core/thrown_error.hpp"
#include "io/levels.hpp"
#include "io/sign.hpp"
#include "io/strokes.hpp"

namespace slipfit::reading {
namespace {

/// The data from which every recording of a part is built.
struct Interpreted {
  Rows rows;
  Conditions conditions;
  Provenance provenance;

  [[nodiscard]] Motion motion() const { return {rows.force, rows.displacement_m}; }
};

/// Normal force and zero: from what the column says to a force.
void interpret_force(Interpreted& part, ForceQuantity column) {
  Conditions& conditions = part.conditions;
  conditions.quantity = column;
  if (column == ForceQuantity::FrictionCoefficient && conditions.normal_force_N) {
    for (double& value : part.rows.force) value *= *conditions.normal_force_N;
    conditions.quantity = ForceQuantity::Force_N;
    part.provenance.assumed.push_back(
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
void restore_clock(Interpreted& part) {
  std::vector<double>& time_s = part.rows.time_s;
  const std::optional<RoundedClock> clock = rounded_clock(time_s);
  if (!clock) return;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    time_s[i] = clock->begin_s + clock->step_s * static_cast<double>(i);
  }
  part.provenance.assumed.push_back(
      fmt::format("The times are rounded to {:.4g} s from an even clock: one sample every {:.6g} s.", clock->rounding_s,
                  clock->step_s));
}

Interpreted interpret(Part part, const LoadedFile& file, const Conditions& conditions) {
  check_part(part, file);
  const StatedConditions stated = state_conditions(part.rows, file.choice, file.layout, conditions, file.name);
  Interpreted result{{}, stated.conditions, describe_part(part, file)};
  const auto append = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
  append(result.provenance.assumed, stated.assumed);
  append(result.provenance.warnings, stated.warnings);
  result.provenance.moved_m_per_s = stated.moved_m_per_s;
  result.rows = std::move(part.rows);
  interpret_force(result, file.choice.force.quantity);
  restore_clock(result);
  return result;
}

void turn_sign(Interpreted& part, const char* reason) {
  for (double& force : part.rows.force) force = -force;
  part.provenance.assumed.emplace_back(reason);
}

/// A force that is negative throughout has the other sign, unless an unknown zero has made it negative: friction rises
/// slowly and falls suddenly. One that is negative for the most part has it where that shows.
void settle_sign(Interpreted& part) {
  const std::vector<double>& force = part.rows.force;
  if (!is_mostly_negative(force)) return;
  const SuddenChanges changes = sudden_changes(force);
  if (!is_negative_throughout(force)) {
    const bool is_turned = changes == SuddenChanges::Rises && find_strokes(part.motion()).empty();
    if (is_turned) turn_sign(part, "The force is mostly negative and rises suddenly: its sign was reversed.");
  } else if (part.conditions.zero_force_N || changes != SuddenChanges::Falls) {
    turn_sign(part, "The force is negative throughout: its sign was reversed.");
  } else {
    part.provenance.assumed.emplace_back(
        "The force is negative throughout, but it rises slowly and falls suddenly as friction does: its sign was kept, "
        "so the zero of the sensor is not at zero force.");
  }
}

Recording create(Interpreted part, const std::string& file) {
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

NamedRecording record(const Interpreted& part, const Stroke& stroke, std::size_t number, const std::string& file) {
  const SampleRange kept = at_full_speed(part.rows, stroke);
  const char sign = stroke.is_positive ? '+' : '-';
  Interpreted own{part.rows.part(kept), part.conditions, part.provenance};
  for (double& force : own.rows.force) force = stroke.is_positive ? force : -force;
  own.provenance.assumed.push_back(
      fmt::format("Stroke {} is {:.6g} to {:.6g} s, without the ends at which the force reverses; its force has the "
                  "sign {} in the file.",
                  number, own.rows.time_s.front(), own.rows.time_s.back(), sign));
  if (const auto moved = moved_m_per_s(part.rows, kept)) {
    auto warning = compare_speed(part.conditions.speed_m_per_s, *moved, "in this stroke the displacement");
    if (warning) own.provenance.warnings.push_back(*std::move(warning));
  }
  return {fmt::format("stroke {} ({})", number, sign), create(std::move(own), file)};
}

ThrownError no_long_stroke(const std::string& file) {
  return ThrownError({"no_strokes", file + ": no stroke of this sign is longer than the reversal of the force; use "
                                           "longer strokes, or a part of one with --window"});
}

/// The force at which the direction reverses: zero where the user states it, else midway between both directions.
double force_at_reversal(const Interpreted& part, const std::vector<Stroke>& strokes) {
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
Interpreted pooled(Interpreted part, std::vector<Stroke> strokes, const std::string& file) {
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
  if (speeds_m_per_s.empty()) return part;
  const double speed_m_per_s = quantile_of(std::move(speeds_m_per_s), 0.5);
  auto warning = compare_speed(part.conditions.speed_m_per_s, speed_m_per_s, "in the strokes the displacement");
  if (warning) part.provenance.warnings.push_back(*std::move(warning));
  return part;
}

}  // namespace

Recording build_recording(Part part, const LoadedFile& file, const Conditions& conditions) {
  Interpreted one = interpret(std::move(part), file, conditions);
  settle_sign(one);
  std::vector<Stroke> strokes = find_strokes(one.motion());
  if (!strokes.empty()) one = pooled(std::move(one), std::move(strokes), file.name);
  return create(std::move(one), file.name);
}

std::vector<NamedRecording> build_strokes(Part part, const LoadedFile& file, const Conditions& conditions) {
  const Interpreted all = interpret(std::move(part), file, conditions);
  const std::vector<Stroke> strokes = take_strokes(all.motion());
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
