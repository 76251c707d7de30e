#include "io/part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/clock_step.hpp"
#include "core/counted.hpp"
#include "core/thrown_error.hpp"
#include "io/columns.hpp"
#include "io/message.hpp"
#include "io/read_options.hpp"
#include "io/steps.hpp"

namespace slipfit::reading {
namespace {

template <class All, class More>
void append(All& all, const More& more) {
  all.insert(all.end(), more.begin(), more.end());
}

std::string rows_of(const Rows& rows, const Step& step) {
  return fmt::format("rows {} to {}", rows.place_of(step.begin).row, rows.place_of(step.end - 1).row);
}

/// Returns the list of steps as text.
std::string several(std::size_t steps) {
  return fmt::format("the file contains {} one after another", counted(steps, "step"));
}

Part take_step(OpenedFile& file) {
  Part part;
  Rows& rows = part.rows;
  rows = std::move(file.rows);
  const auto steps = find_steps(rows);
  Step taken{{0, rows.time_s.size()}};
  if (const auto& wanted = file.options.step) {
    taken = step_with_number(steps, *wanted, file.name);
    part.assume(
        fmt::format("Only step {} was read ({}; {}).", taken.number, rows_of(rows, taken), several(steps.size())));
  } else if (steps.size() > 1 && are_one_recording(rows, steps)) {
    part.assume(fmt::format("All {} of the file were read as one recording; --step N selects one.",
                            counted(steps.size(), "step")));
  } else if (steps.size() > 1) {
    taken = main_step(steps);
    part.provenance.warnings.push_back(
        {"several_steps",
         fmt::format("{}; only step {} was analysed ({}); --step N selects another (slipfit info lists them)",
                     several(steps.size()), taken.number, rows_of(rows, taken))});
    part.assume(fmt::format("Step {} is the recording ({}).", taken.number, rows_of(rows, taken)));
  }
  rows.cut(taken);
  return part;
}

/// Leaves out what lies before an earlier sample.
void order_by_time(Part& part) {
  std::vector<double>& time_s = part.rows.time_s;
  part.in_window = time_s.size();
  std::size_t& backward = part.provenance.rows_backward_in_time;
  std::size_t& repeating = part.provenance.rows_repeating_time;
  if (const ClockOrder order = order_of(time_s); order.backward == 0) {
    repeating = order.repeating;
    return;
  }
  std::vector<std::size_t> kept{0};
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double latest_s = time_s[kept.back()];
    const bool is_backward = time_s[i] < latest_s;
    if (is_backward && backward++ == 0) part.first_backward_line = part.rows.place_of(i).line;
    if (is_backward) continue;
    if (time_s[i] == latest_s) ++repeating;
    kept.push_back(i);
  }
  part.rows.keep(kept);
}

constexpr double kMostBackward = 0.02;
constexpr double kCoarse = 2.0;      // rows on one time stamp, from which on the sampling rate is the better clock
constexpr double kTooCoarse = 10.0;  // the same, from which on slips cannot be placed between the stamps

/// Rows on one time stamp, on average.
double rows_per_stamp(const Part& part) {
  const auto rows = static_cast<double>(part.rows.time_s.size());
  return rows / std::max(1.0, rows - static_cast<double>(part.provenance.rows_repeating_time));
}

/// "--sample-rate 5000": rows over time from the first change of the stamp to the last one.
std::string advised_rate(const std::vector<double>& time_s) {
  const auto first = std::ranges::find_if(time_s, [&](double t) { return t != time_s.front(); });
  const auto last = std::ranges::find(time_s, time_s.back());
  if (first == time_s.end() || !(*first < *last)) return "--sample-rate";
  return fmt::format("--sample-rate {:.4g}", static_cast<double>(last - first) / (*last - *first));
}

std::string clock_range(const Rows& rows) {
  return rows.clock ? fmt::format("the clock runs from {} to {} s", rows.clock->begin_s, rows.clock->end_s)
                    : std::string("no row has a time");
}

/// Returns advice to state the sampling rate if it is the better clock, otherwise nothing.
std::string advice_on_clock(const Part& part) {
  if (rows_per_stamp(part) < kCoarse) return {};
  return fmt::format(
      "; the clock is coarser than the sampling: if the rows are evenly spaced, state the sampling rate with {}",
      advised_rate(part.rows.time_s));
}

Warnings warn_of_rows(const Part& part) {
  const Provenance& counts = part.provenance;
  Warnings warnings;
  if (counts.rows_without_number > 0) {
    warnings.push_back(
        {"rows_without_number", counted(counts.rows_without_number, "row") + " without a number left out"});
  }
  if (counts.rows_backward_in_time > 0) {
    warnings.push_back({"time_runs_backwards",
                        fmt::format("{} with a time before that of an earlier row left out (the first is line {})",
                                    counted(counts.rows_backward_in_time, "row"), part.first_backward_line)});
  }
  if (counts.rows_repeating_time > 0) {
    warnings.push_back({"repeated_time_stamps",
                        counted(counts.rows_repeating_time, "repeated time stamp") + " kept" + advice_on_clock(part)});
  }
  return warnings;
}

/// Error: unread_numbers.
void check_unread(const Rows& rows, const OpenedFile& file) {
  if (!rows.unread) return;
  const bool is_time = file.choice.time && rows.unread->column == file.choice.time->column;
  throw ThrownError(
      {"unread_numbers",
       fmt::format("{}:{}: {} such as '{}' in {} cannot be read as numbers in more than a tenth of the rows; write "
                   "digits, one decimal sign and a leading minus, or choose another column with {}",
                   file.name, rows.unread->first_line, counted(rows.unread->count, "cell"),
                   printable_utf8(rows.unread->example), describe(file.layout, rows.unread->column),
                   is_time ? "--time-column" : "--force-column")});
}

/// Nothing, or next to nothing, in what was asked for. Errors: window_empty, part_empty.
void check_extent(const Rows& rows, const OpenedFile& file) {
  if (rows.time_s.size() >= 2) return;
  const std::string held = counted(rows.time_s.size(), "sample");
  if (file.options.window && rows.clock) {
    throw ThrownError({"window_empty",
                       fmt::format("{}: the window {}:{} s contains {}; {}; choose another with --window", file.name,
                                   file.options.window->begin_s, file.options.window->end_s, held, clock_range(rows))});
  }
  const auto& where = file.choice.where;
  if (!file.options.rows && !where) return;
  const std::string rows_asked =
      file.options.rows ? fmt::format("rows {}:{}", file.options.rows->first, file.options.rows->last) : "all rows";
  const std::string of_where =
      where ? fmt::format(" with '{1}' in {0}", describe(file.layout, where->column), printable_utf8(where->text)) : "";
  throw ThrownError(
      {"part_empty", fmt::format("{}: {}{} contain {}; the file has {}: choose others with {}", file.name, rows_asked,
                                 of_where, held, counted(rows.count, "row"), where ? "--where" : "--rows")});
}

/// Error: time_too_coarse.
void check_stamps(const Part& part, const OpenedFile& file) {
  if (!file.choice.time || rows_per_stamp(part) < kTooCoarse) return;
  throw ThrownError({"time_too_coarse",
                     fmt::format("{}:{}: {} rows share each time in {} on average, so the clock is coarser than the "
                                 "sampling; if the rows are evenly spaced, give the sampling rate ({})",
                                 file.name, file.layout.first_data_line, std::lround(rows_per_stamp(part)),
                                 describe(file.layout, file.choice.time->column), advised_rate(part.rows.time_s))});
}

/// About the file and this part of it, in words.
std::vector<std::string> sentences_of(const Part& part, const OpenedFile& file) {
  const Rows& rows = part.rows;
  const ReadOptions& options = file.options;
  std::vector<std::string> sentences = file.choice.assumed;
  if (rows.text_lines > 0) {
    sentences.push_back(fmt::format("{} of text among the data {} skipped (the first is line {}).",
                                    counted(rows.text_lines, "line"), rows.text_lines == 1 ? "was" : "were",
                                    rows.first_text_line));
  }
  if (options.rows) {
    sentences.push_back(
        fmt::format("Only the rows {}:{} of {} were read.", options.rows->first, options.rows->last, rows.count));
  }
  if (const auto& where = file.choice.where) {
    sentences.push_back(fmt::format("Only rows with '{1}' in {0} were read.", describe(file.layout, where->column),
                                    printable_utf8(where->text)));
  }
  append(sentences, part.provenance.assumed);
  if (options.window) {
    sentences.push_back(fmt::format("Only the window {}:{} s was read; {}.", options.window->begin_s,
                                    options.window->end_s, clock_range(rows)));
  }
  return sentences;
}

/// Errors: those of describe_part.
void check_part(const Part& part, const OpenedFile& file) {
  const Rows& rows = part.rows;
  check_unread(rows, file);
  const std::string force = describe(file.layout, file.choice.force.column);
  const std::size_t backward = part.provenance.rows_backward_in_time;
  if (static_cast<double>(backward) > kMostBackward * static_cast<double>(part.in_window)) {
    throw ThrownError(
        {"time_runs_backwards",
         fmt::format("{}:{}: time runs backwards in {} of {}; is {} the time? Choose another with --time-column, or a "
                     "part with --window or --rows",
                     file.name, part.first_backward_line, backward, counted(part.in_window, "row"),
                     file.choice.time ? describe(file.layout, file.choice.time->column) : "it")});
  }
  check_extent(rows, file);
  if (rows.time_s.empty()) {
    throw ThrownError(
        {"no_number_in_column",
         fmt::format("{}:{}: {} has no number with a time in any of {}; choose another with --force-column", file.name,
                     file.layout.first_data_line, force, counted(rows.without_number, "row"))});
  }
  if (rows.time_s.size() < 2) {
    throw ThrownError({"too_few_samples", fmt::format("{}:{}: only one row of numbers; a recording needs at least 2",
                                                      file.name, file.layout.first_data_line)});
  }
  if (rows.time_s.front() == rows.time_s.back()) {
    throw ThrownError(
        {"time_constant",
         fmt::format("{}:{}: the time is {} s in all of {}; choose another column with --time-column", file.name,
                     file.layout.first_data_line, rows.time_s.front(), counted(rows.time_s.size(), "row"))});
  }
  check_stamps(part, file);
}

}  // namespace

Part take_part(OpenedFile& file) {
  Part part = take_step(file);
  if (file.options.step && file.options.window) part.rows.keep_wanted({}, file.options.window);
  order_by_time(part);
  return part;
}

std::vector<Part> take_segments(const Rows& rows) {
  std::vector<Part> segments;
  for (const Step& step : segments_of_steps(rows, find_steps(rows))) {
    Part part;
    part.rows = rows;
    part.rows.cut(step);
    part.assume(fmt::format("Segment {} was read ({}).", step.number, rows_of(rows, step)));
    order_by_time(part);
    segments.push_back(std::move(part));
  }
  return segments;
}

void describe_part(Part& part, const OpenedFile& file) {
  Provenance& provenance = part.provenance;
  provenance.rows_without_number = part.rows.without_number;
  check_part(part, file);
  provenance.file = file.name;
  provenance.input_digest = part.rows.digest;
  provenance.input_bytes = part.rows.bytes;
  provenance.assumed = sentences_of(part, file);
  Warnings warnings = file.warnings;
  append(warnings, file.choice.warnings);
  append(warnings, warn_of_rows(part));
  append(warnings, provenance.warnings);
  provenance.warnings = std::move(warnings);
  provenance.is_time_unit_assumed = file.choice.time && file.choice.time->is_unit_assumed;
  provenance.window_given = file.options.window.has_value() || file.options.rows.has_value();
  provenance.options = stated_cells(file.options);
}

}  // namespace slipfit::reading
