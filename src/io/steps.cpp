#include "io/steps.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "core/clock_step.hpp"
#include "core/counted.hpp"
#include "core/statistics.hpp"
#include "core/thrown_error.hpp"
#include "io/message.hpp"

namespace slipfit::reading {

namespace {

constexpr std::size_t kBlocksOfColumn = 512;
constexpr double kOff = 0.5;  // of the 90 % level
constexpr double kSteadyWithin = 0.1;
constexpr double kSteadyPart = 0.8;
constexpr double kNormalQuartile = 0.6745;    // of a normal distribution, in standard deviations
constexpr std::size_t kShortestStretch = 20;  // parts of the column

std::vector<double> finite(std::span<const double> values) {
  std::vector<double> kept;
  std::ranges::copy_if(values, std::back_inserter(kept), [](double v) { return std::isfinite(v); });
  return kept;
}

std::size_t block_size(std::size_t samples) {
  return std::max<std::size_t>(1, samples / kBlocksOfColumn);
}

/// 0 where a block holds no number.
std::vector<double> block_medians(std::span<const double> values) {
  const std::size_t size = block_size(values.size());
  std::vector<double> medians;
  for (std::size_t begin = 0; begin < values.size(); begin += size) {
    const auto block = finite(values.subspan(begin, std::min(size, values.size() - begin)));
    medians.push_back(block.empty() ? 0.0 : quantile_of(block, 0.5));
  }
  return medians;
}

/// Returns true if the halves differ by more than the bound.
bool drifts(std::span<const double> blocks, double bound) {
  const std::size_t half = blocks.size() / 2;
  return half > 0 && std::abs(mean_of(blocks.first(half)) - mean_of(blocks.last(half))) > bound;
}

}  // namespace

std::optional<Level> level_of(std::span<const double> values) {
  auto on = finite(values);
  if (on.empty()) return std::nullopt;
  const double threshold = kOff * quantile_of(on, 0.9);
  std::erase_if(on, [&](double v) { return !(v > threshold); });
  if (on.empty()) return std::nullopt;
  Level level{quantile_of(on, 0.5), 0.0, false};
  for (double& v : on) v = std::abs(v - level.value);
  level.standard_deviation = quantile_of(on, 0.5) / kNormalQuartile;
  auto blocks = block_medians(values);
  std::erase_if(blocks, [&](double v) { return !(v > threshold); });
  const auto near =
      std::ranges::count_if(blocks, [&](double v) { return std::abs(v - level.value) <= kSteadyWithin * level.value; });
  level.is_steady = static_cast<double>(near) >= kSteadyPart * static_cast<double>(blocks.size());
  return level;
}

std::vector<double> block_speeds_m_per_s(std::span<const double> time_s, std::span<const double> displacement_m,
                                         std::size_t blocks) {
  const std::size_t step = std::max<std::size_t>(1, time_s.size() / blocks);
  std::vector<double> speeds;
  for (std::size_t i = step; i < time_s.size(); i += step) {
    const double speed = std::abs(displacement_m[i] - displacement_m[i - step]) / (time_s[i] - time_s[i - step]);
    if (std::isfinite(speed)) speeds.push_back(speed);
  }
  return speeds;
}

namespace {

/// The stretches in which the column holds one level each, to the given relative tolerance, where there are several
/// levels; a stretch of less than a twentieth of the samples is none. Empty where the column drifts.
std::vector<SampleRange> stretches_of_levels(std::span<const double> values, double tolerance) {
  const auto blocks = block_medians(values);
  const std::size_t size = block_size(values.size());
  const double standing = blocks.empty() ? 0.0 : tolerance * *std::ranges::max_element(blocks);
  std::vector<SampleRange> stretches;
  double lowest = HUGE_VAL;
  double highest = 0.0;
  for (std::size_t begin = 0; begin < blocks.size();) {
    std::size_t end = begin;
    double sum = 0.0;
    do {
      sum += blocks[end++];
    } while (end < blocks.size() && std::abs(blocks[end] * static_cast<double>(end - begin) - sum) <= tolerance * sum);
    const double mean = sum / static_cast<double>(end - begin);
    if (mean > standing && (end - begin) * kShortestStretch >= blocks.size()) {
      if (drifts(std::span(blocks).subspan(begin, end - begin), 0.25 * tolerance * mean)) return {};
      stretches.push_back({begin * size, std::min(end * size, values.size())});
      lowest = std::min(lowest, mean);
      highest = std::max(highest, mean);
    }
    begin = end;
  }
  const bool are_levels = stretches.size() > 1 && highest > (1.0 + 2.0 * tolerance) * lowest;
  return are_levels ? stretches : std::vector<SampleRange>{};
}

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
    const std::size_t after = std::min(steps[i].begin + kFewestRows, steps[i].end) - 1;
    if (rows.time_s[after] < rows.time_s[before]) return false;
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
  const std::string known =
      listed(steps.size(), kMostNamed, [&](std::size_t i) { return std::to_string(steps[i].number); });
  throw ThrownError(
      {"unknown_step",
       fmt::format(
           "{}: step {} does not exist; the file contains {} ({}); choose one of them with --step, or leave it out",
           file, number, counted(steps.size(), "step"), known)});
}

}  // namespace slipfit::reading
