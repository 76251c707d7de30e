#include "io/steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/clock_step.hpp"
#include "core/thrown_error.hpp"
#include "io/levels.hpp"
#include "io/message.hpp"

namespace slipfit::reading {
namespace {

constexpr std::size_t kFewestRows = 8;  // of a step: what is shorter is a slip of the clock or of the exporter
constexpr double kSpeedStep = 0.1;
constexpr double kLoadStep = 0.2;
constexpr double kAboutAsLong = 0.9;
constexpr std::size_t kMostNamed = 8;

/// Returns true if a run of rows starts here with times before the rows above it: the clock has started again. A few
/// time stamps that go back and return are damage, and so is a clock that goes back by less than half.
bool clock_restarts(const std::vector<double>& time_s, std::size_t at, double begin_s, double latest_s) {
  if (at + kFewestRows > time_s.size() || time_s[at] > 0.5 * (begin_s + latest_s)) return false;
  for (std::size_t i = at + 1; i < at + kFewestRows; ++i) {
    if (time_s[i] < time_s[i - 1] || time_s[i] >= latest_s) return false;
  }
  return true;
}

std::vector<std::size_t> clock_begins(const std::vector<double>& time_s) {
  std::vector<std::size_t> begins;
  if (order_of(time_s).backward == 0) return begins;
  double begin_s = time_s.front();
  double latest_s = begin_s;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    if (time_s[i] < latest_s && clock_restarts(time_s, i, begin_s, latest_s)) {
      begins.push_back(i);
      begin_s = latest_s = time_s[i];
    }
    latest_s = std::max(latest_s, time_s[i]);
  }
  return begins;
}

std::vector<std::size_t> changes_of(const std::vector<double>& step) {
  std::vector<std::size_t> changes;
  for (std::size_t i = 1; i < step.size(); ++i) {
    if (std::isfinite(step[i]) && std::isfinite(step[i - 1]) && step[i] != step[i - 1]) changes.push_back(i);
  }
  const bool counts_something_else = changes.size() * kFewestRows > step.size();
  return counts_something_else ? std::vector<std::size_t>{} : changes;
}

/// Returns both, except those of the second that are next to one of the first.
std::vector<std::size_t> joined(std::vector<std::size_t> first, const std::vector<std::size_t>& second) {
  const std::vector<std::size_t> given = first;
  for (const std::size_t at : second) {
    const auto beside = std::ranges::find_if(
        given, [&](std::size_t other) { return std::max(at, other) - std::min(at, other) < kFewestRows; });
    if (beside == given.end()) first.push_back(at);
  }
  std::ranges::sort(first);
  return first;
}

/// The numbers of the file, where every step has one of its own; else 1, 2, ...
void number(std::vector<Step>& steps, const std::vector<double>& column) {
  std::set<double> own;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    steps[i].number = i + 1;
    if (!column.empty() && column[steps[i].begin] >= 0.0) own.insert(column[steps[i].begin]);
  }
  if (own.size() != steps.size()) return;
  for (Step& step : steps) step.number = static_cast<std::size_t>(column[step.begin]);
}

std::vector<Step> steps_of_levels(const Rows& rows) {
  auto stretches = stretches_of_levels(rows.speed_m_per_s, kSpeedStep);
  if (stretches.empty()) stretches = stretches_of_levels(rows.normal_force_N, kLoadStep);
  std::vector<Step> steps;
  steps.reserve(stretches.size());
  for (const SampleRange& stretch : stretches) steps.push_back({stretch, steps.size() + 1});
  if (steps.empty()) steps.push_back({{0, rows.time_s.size()}});
  return steps;
}

bool is_level_kept(const std::vector<double>& column, std::span<const Step> steps, double tolerance) {
  if (column.empty()) return true;
  std::vector<double> levels;
  for (const Step& step : steps) {
    const auto level = level_of(step.of(column));
    if (level) levels.push_back(level->value);
  }
  if (levels.empty()) return true;
  const auto [lowest, highest] = std::ranges::minmax_element(levels);
  return *highest <= (1.0 + tolerance) * *lowest;
}

}  // namespace

std::vector<Step> find_steps(const Rows& rows) {
  if (rows.time_s.empty()) return {Step{}};
  auto begins = joined(joined(changes_of(rows.step), rows.blocks), clock_begins(rows.time_s));
  if (begins.empty()) return steps_of_levels(rows);
  begins.insert(begins.begin(), 0);
  std::vector<Step> steps;
  for (std::size_t i = 0; i < begins.size(); ++i) {
    steps.push_back({{begins[i], i + 1 < begins.size() ? begins[i + 1] : rows.time_s.size()}});
  }
  number(steps, rows.step);
  return steps;
}

bool are_one_recording(const Rows& rows, std::span<const Step> steps) {
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const std::size_t before = steps[i].begin - std::min(steps[i].begin, kFewestRows);
    const std::size_t behind = std::min(steps[i].begin + kFewestRows, steps[i].end) - 1;
    if (rows.time_s[behind] < rows.time_s[before]) return false;
  }
  return is_level_kept(rows.speed_m_per_s, steps, kSpeedStep) && is_level_kept(rows.normal_force_N, steps, kLoadStep);
}

std::vector<Step> segments_of_steps(const Rows& rows, std::span<const Step> steps) {
  if (rows.speed_m_per_s.empty()) return {steps.begin(), steps.end()};
  std::vector<Step> segments;
  for (const Step& step : steps) {
    const auto speed = step.of(rows.speed_m_per_s);
    auto levels = stretches_of_levels(speed, kSpeedStep);
    const auto level = level_of(speed);
    if (levels.empty() && level && level->is_steady) levels.push_back({0, speed.size()});
    for (const SampleRange& range : levels) {
      segments.push_back({{step.begin + range.begin, step.begin + range.end}, segments.size() + 1});
    }
  }
  return segments;
}

const Step& main_step(std::span<const Step> steps) {
  const auto length = [](const Step& step) { return static_cast<double>(step.size()); };
  double longest = 0.0;
  for (const Step& step : steps) longest = std::max(longest, length(step));
  return *std::ranges::find_if(steps, [&](const Step& step) { return length(step) >= kAboutAsLong * longest; });
}

Step step_with_number(std::span<const Step> steps, std::size_t number, const std::string& file) {
  const auto found = std::ranges::find_if(steps, [&](const Step& step) { return step.number == number; });
  if (found != steps.end()) return *found;
  if (number >= 1 && number <= steps.size()) return steps[number - 1];
  std::string known;
  for (std::size_t i = 0; i < std::min(steps.size(), kMostNamed); ++i) {
    known += fmt::format("{}{}", i == 0 ? "" : ", ", steps[i].number);
  }
  if (steps.size() > kMostNamed) known += ", ...";
  throw ThrownError(
      {"unknown_step",
       fmt::format(
           "{}: step {} does not exist; the file contains {} ({}); choose one of them with --step, or leave it out",
           file, number, counted(steps.size(), "step"), known)});
}

}  // namespace slipfit::reading
