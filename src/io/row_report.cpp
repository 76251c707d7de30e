#include "io/row_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/column_search.hpp"
#include "io/message.hpp"

namespace slipfit::reading {
namespace {

constexpr double kMostBackward = 0.02;
constexpr double kSpeedTolerance = 0.05;

std::string describe_range(const Rows& rows) {
  return rows.clock ? fmt::format("the clock runs from {} to {} s", rows.clock->begin_s, rows.clock->end_s)
                    : std::string("no row has a time");
}

Warnings warn_of_rows(const Rows& rows) {
  Warnings warnings;
  if (rows.without_number > 0) {
    warnings.push_back({"rows_without_number", counted(rows.without_number, "row") + " without a number left out"});
  }
  if (rows.backward > 0) {
    warnings.push_back({"time_runs_backwards",
                        fmt::format("{} with a time before that of an earlier row left out (the first is line {})",
                                    counted(rows.backward, "row"), rows.first_backward_line)});
  }
  if (rows.repeating > 0) {
    warnings.push_back(
        {"repeated_time_stamps", counted(rows.repeating, "row") + " with the same time as the row before (kept)"});
  }
  return warnings;
}

}  // namespace

std::optional<Error> check_rows(const Rows& rows, const RowPlan& plan, const std::string& file) {
  const std::string force = describe(plan.layout, plan.choice.force.column);
  if (static_cast<double>(rows.backward) > kMostBackward * static_cast<double>(rows.in_window)) {
    return Error{
        "time_runs_backwards",
        fmt::format("{}:{}: time runs backwards in {} of {}; is {} the time? Choose another with --time-column, or a "
                    "part with --window",
                    file, rows.first_backward_line, rows.backward, counted(rows.in_window, "row"),
                    plan.choice.time ? describe(plan.layout, plan.choice.time->column) : "it")};
  }
  if (rows.time_s.size() < 2 && plan.window && rows.clock) {
    return Error{"window_empty",
                 fmt::format("{}: the window {}:{} s holds {}; {}", file, plan.window->begin_s, plan.window->end_s,
                             counted(rows.time_s.size(), "sample"), describe_range(rows))};
  }
  if (rows.time_s.empty()) {
    return Error{"no_number_in_column",
                 fmt::format("{}:{}: {} holds a number with a time in none of {}; choose another with "
                             "--force-column",
                             file, plan.layout.first_data_line, force, counted(rows.without_number, "row"))};
  }
  if (rows.time_s.size() < 2) {
    return Error{"too_few_samples", fmt::format("{}:{}: only one row of numbers; a recording needs at least 2", file,
                                                plan.layout.first_data_line)};
  }
  if (rows.time_s.front() == rows.time_s.back()) {
    return Error{"time_constant",
                 fmt::format("{}:{}: the time is {} s in all of {}; choose another column with --time-column", file,
                             plan.layout.first_data_line, rows.time_s.front(), counted(rows.time_s.size(), "row"))};
  }
  return std::nullopt;
}

Provenance describe_rows(const Rows& rows, const RowPlan& plan, const std::string& file) {
  Provenance provenance;
  provenance.file = file;
  provenance.input_digest = rows.digest;
  provenance.input_bytes = rows.bytes;
  provenance.assumed = plan.choice.assumed;
  provenance.rows_without_number = rows.without_number;
  provenance.rows_backward_in_time = rows.backward;
  provenance.rows_repeating_time = rows.repeating;
  provenance.warnings = warn_of_rows(rows);
  if (rows.text_lines > 0) {
    provenance.assumed.push_back(fmt::format("{} of text among the data {} skipped (the first is line {}).",
                                             counted(rows.text_lines, "line"), rows.text_lines == 1 ? "was" : "were",
                                             rows.first_text_line));
  }
  provenance.window_given = plan.window.has_value();
  if (plan.window) {
    provenance.assumed.push_back(fmt::format("Only the window {}:{} s was read; {}.", plan.window->begin_s,
                                             plan.window->end_s, describe_range(rows)));
  }
  return provenance;
}

std::optional<Warning> compare_speeds(const Rows& rows, const RowPlan& plan, double stated_m_per_s) {
  if (!plan.choice.displacement || !(stated_m_per_s > 0.0)) return std::nullopt;
  const auto speed_m_per_s = steady_speed_m_per_s(rows.displacement);
  if (!speed_m_per_s || std::abs(*speed_m_per_s - stated_m_per_s) <= kSpeedTolerance * stated_m_per_s)
    return std::nullopt;
  return Warning{"speed_differs_from_displacement",
                 fmt::format("the speed is given as {:.6g} m/s, but {} moves at {:.6g} m/s", stated_m_per_s,
                             describe(plan.layout, plan.choice.displacement->column), *speed_m_per_s)};
}

}  // namespace slipfit::reading
