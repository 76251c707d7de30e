#include "io/part.hpp"

#include <fmt/format.h>

#include <utility>

#include "io/message.hpp"
#include "io/steps.hpp"

namespace slipfit::reading {
namespace {

std::string rows_of(const Rows& rows, const Step& step) {
  return fmt::format("rows {} to {}", rows.place_of(step.begin).row, rows.place_of(step.end - 1).row);
}

/// Which steps there are, in words.
std::string several(std::size_t steps) {
  return fmt::format("the file holds {} one after another", counted(steps, "step"));
}

Result<Part> take_step(Rows rows, const ReadOptions& options, const std::string& file) {
  Part part;
  const auto steps = find_steps(rows);
  Step taken{1, 0, rows.time_s.size()};
  if (options.step) {
    const auto step = step_with_number(steps, *options.step, file);
    if (!step) return step.error();
    taken = step.value();
    part.assumed.push_back(
        fmt::format("Only step {} was read ({}; {}).", taken.number, rows_of(rows, taken), several(steps.size())));
  } else if (steps.size() > 1 && are_one_recording(rows, steps)) {
    part.assumed.push_back(fmt::format("All {} of the file were read as one recording; --step N takes one.",
                                       counted(steps.size(), "step")));
  } else if (steps.size() > 1) {
    taken = main_step(steps);
    part.warnings.push_back(
        {"several_steps", fmt::format("{}, and only step {} was analysed ({}); choose another with --step N "
                                      "(slipfit info lists them)",
                                      several(steps.size()), taken.number, rows_of(rows, taken))});
    part.assumed.push_back(fmt::format("Step {} is the recording ({}).", taken.number, rows_of(rows, taken)));
  }
  rows.cut(taken.begin, taken.end);
  part.rows = std::move(rows);
  return part;
}

void take_window(Rows& rows, const TimeWindow& window) {
  if (rows.time_s.empty()) return;
  std::vector<std::size_t> inside;
  TimeWindow clock{rows.time_s.front(), rows.time_s.front()};
  for (std::size_t i = 0; i < rows.time_s.size(); ++i) {
    const double time_s = rows.time_s[i];
    clock = {std::min(clock.begin_s, time_s), std::max(clock.end_s, time_s)};
    if (time_s >= window.begin_s && time_s <= window.end_s) inside.push_back(i);
  }
  rows.clock = clock;
  rows.keep(inside);
}

/// Leaves out what lies before an earlier sample.
void order_by_time(Part& part) {
  std::vector<double>& time_s = part.rows.time_s;
  part.in_window = time_s.size();
  std::size_t latest = 0;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const bool is_backward = time_s[i] < time_s[latest];
    if (is_backward && part.backward++ == 0) part.first_backward_line = part.rows.place_of(i).line;
    if (is_backward) continue;
    if (time_s[i] == time_s[latest]) ++part.repeating;
    latest = i;
  }
  if (part.backward == 0) return;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (kept.empty() || time_s[i] >= time_s[kept.back()]) kept.push_back(i);
  }
  part.rows.keep(kept);
}

}  // namespace

Result<Part> take_part(Rows rows, const ReadOptions& options, const std::string& file) {
  auto taken = take_step(std::move(rows), options, file);
  if (!taken) return taken;
  Part part = std::move(taken).value();
  if (options.step && options.window) take_window(part.rows, *options.window);
  order_by_time(part);
  return part;
}

}  // namespace slipfit::reading
