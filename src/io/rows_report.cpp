#include "io/rows_report.hpp"

#include <fmt/format.h>

#include "io/column_search.hpp"
#include "io/message.hpp"

namespace slipfit::reading {
namespace {

constexpr double kMostBackward = 0.02;

std::string clock_range(const Rows& rows) {
  return rows.clock ? fmt::format("the clock runs from {} to {} s", rows.clock->begin_s, rows.clock->end_s)
                    : std::string("no row has a time");
}

Warnings warn_of_rows(const Part& part) {
  Warnings warnings;
  if (part.rows.without_number > 0) {
    warnings.push_back(
        {"rows_without_number", counted(part.rows.without_number, "row") + " without a number left out"});
  }
  if (part.backward > 0) {
    warnings.push_back({"time_runs_backwards",
                        fmt::format("{} with a time before that of an earlier row left out (the first is line {})",
                                    counted(part.backward, "row"), part.first_backward_line)});
  }
  if (part.repeating > 0) {
    warnings.push_back(
        {"repeated_time_stamps", counted(part.repeating, "row") + " with the same time as the row before (kept)"});
  }
  return warnings;
}

/// Nothing, or next to nothing, in what was asked for. Errors: window_empty, part_empty.
std::optional<Error> check_extent(const Rows& rows, const RowPlan& plan, const std::string& file) {
  if (rows.time_s.size() >= 2) return std::nullopt;
  const std::string held = counted(rows.time_s.size(), "sample");
  if (plan.window && rows.clock) {
    return Error{"window_empty", fmt::format("{}: the window {}:{} s holds {}; {}", file, plan.window->begin_s,
                                             plan.window->end_s, held, clock_range(rows))};
  }
  const auto& where = plan.choice.where;
  if (!plan.rows && !where) return std::nullopt;
  const std::string rows_asked = plan.rows ? fmt::format("rows {}:{}", plan.rows->first, plan.rows->last) : "all rows";
  const std::string of_where =
      where ? fmt::format(" where {} says '{}'", describe(plan.layout, where->column), printable(where->text)) : "";
  return Error{"part_empty", fmt::format("{}: {}{} hold {}; the file has {}: choose others with {}", file, rows_asked,
                                         of_where, held, counted(rows.count, "row"), where ? "--where" : "--rows")};
}

/// About a part of the file, in words.
std::vector<std::string> part_sentences(const Part& part, const RowPlan& plan) {
  std::vector<std::string> sentences;
  if (plan.rows) {
    sentences.push_back(
        fmt::format("Only the rows {}:{} of {} were read.", plan.rows->first, plan.rows->last, part.rows.count));
  }
  if (plan.choice.where) {
    sentences.push_back(fmt::format("Only rows where {} says '{}' were read.",
                                    describe(plan.layout, plan.choice.where->column),
                                    printable(plan.choice.where->text)));
  }
  sentences.insert(sentences.end(), part.assumed.begin(), part.assumed.end());
  if (plan.window) {
    sentences.push_back(fmt::format("Only the window {}:{} s was read; {}.", plan.window->begin_s, plan.window->end_s,
                                    clock_range(part.rows)));
  }
  return sentences;
}

}  // namespace

std::optional<Error> check_part(const Part& part, const RowPlan& plan, const std::string& file) {
  const Rows& rows = part.rows;
  const std::string force = describe(plan.layout, plan.choice.force.column);
  if (static_cast<double>(part.backward) > kMostBackward * static_cast<double>(part.in_window)) {
    return Error{
        "time_runs_backwards",
        fmt::format("{}:{}: time runs backwards in {} of {}; is {} the time? Choose another with --time-column, or a "
                    "part with --window or --rows",
                    file, part.first_backward_line, part.backward, counted(part.in_window, "row"),
                    plan.choice.time ? describe(plan.layout, plan.choice.time->column) : "it")};
  }
  if (auto error = check_extent(rows, plan, file)) return error;
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

Provenance describe_part(const Part& part, const RowPlan& plan, const std::string& file) {
  Provenance provenance;
  provenance.file = file;
  provenance.input_digest = part.rows.digest;
  provenance.input_bytes = part.rows.bytes;
  provenance.assumed = plan.choice.assumed;
  provenance.rows_without_number = part.rows.without_number;
  provenance.rows_backward_in_time = part.backward;
  provenance.rows_repeating_time = part.repeating;
  provenance.warnings = warn_of_rows(part);
  provenance.warnings.insert(provenance.warnings.end(), part.warnings.begin(), part.warnings.end());
  if (part.rows.text_lines > 0) {
    provenance.assumed.push_back(fmt::format("{} of text among the data {} skipped (the first is line {}).",
                                             counted(part.rows.text_lines, "line"),
                                             part.rows.text_lines == 1 ? "was" : "were", part.rows.first_text_line));
  }
  provenance.window_given = plan.window.has_value() || plan.rows.has_value();
  for (std::string& sentence : part_sentences(part, plan)) provenance.assumed.push_back(std::move(sentence));
  return provenance;
}

}  // namespace slipfit::reading
