#include "slipfit/io/recording_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <new>
#include <utility>

#include "io/column_search.hpp"
#include "io/columns.hpp"
#include "io/layout.hpp"
#include "io/message.hpp"
#include "io/rows.hpp"
#include "io/sign.hpp"
#include "io/text_source.hpp"

namespace slipfit {
namespace {

using namespace reading;

constexpr std::size_t kHead = std::size_t{64} * 1024;
constexpr std::size_t kLongHead = std::size_t{4} * 1024 * 1024;  // for a preamble that fills the first part
constexpr std::size_t kLongestLine = kLongHead / 4;              // of a file without rows of numbers in its head
constexpr std::size_t kMostReserved = std::size_t{1} << 27;

std::optional<Error> check_options(const ReadOptions& options, const std::string& file) {
  if (const auto& window = options.window; window && !(window->begin_s < window->end_s)) {
    return Error{"bad_window", fmt::format("{}: the window {}:{} s is empty; give T0:T1 in seconds with T0 < T1", file,
                                           window->begin_s, window->end_s)};
  }
  if (const auto& rate = options.sample_rate_Hz; rate && !(*rate > 0.0 && std::isfinite(*rate))) {
    return Error{"bad_sample_rate",
                 fmt::format("{}: the sampling rate {} is not a positive number of samples a second; "
                             "correct --sample-rate",
                             file, *rate)};
  }
  return std::nullopt;
}

Result<Layout> layout_of_head(TextSource& source, const std::string& file) {
  for (const std::size_t size : {kHead, kLongHead}) {
    auto lines = split_lines(source.head(size));
    const std::size_t last_length = lines.empty() ? 0 : lines.back().size();
    if (!source.head_is_everything() && !lines.empty()) lines.pop_back();  // may be cut
    if (auto layout = find_layout(lines)) return *std::move(layout);
    if (!source.head_is_everything() && last_length > kLongestLine) {
      return Error{"line_too_long", fmt::format("{}:{}: the line is longer than {} MB, which is too many columns; a "
                                                "recording is text with a row a line, of a time and a force",
                                                file, lines.size() + 1, kLongestLine >> 20)};
    }
    if (!source.head_is_everything()) continue;
    const bool is_blank =
        std::all_of(lines.begin(), lines.end(), [](std::string_view line) { return trim(line).empty(); });
    if (is_blank) return Error{"empty_file", file + ": the file holds only blank lines; export the recording again"};
    break;
  }
  return Error{"no_numeric_column", file +
                                        ": no rows of numbers found; is this the right file? A recording is text with "
                                        "a column of times and one of forces"};
}

struct Interpreted {
  std::vector<double> force;
  Conditions conditions;
  std::vector<std::string> assumed;
  Warnings warnings;
};

/// Normal force, zero and sign: from what the column says to the force that opposes the motion.
Interpreted interpret_force(std::vector<double> force, const Conditions& conditions, ForceQuantity column) {
  Interpreted result{std::move(force), conditions, {}, {}};
  result.conditions.quantity = column;
  const auto change = [&](double factor, double offset) {
    for (double& value : result.force) value = value * factor + offset;
  };
  if (column == ForceQuantity::FrictionCoefficient && conditions.normal_force_N) {
    change(*conditions.normal_force_N, 0.0);
    result.conditions.quantity = ForceQuantity::Force_N;
    result.assumed.push_back(
        fmt::format("Force is the friction coefficient times the normal force of {} N.", *conditions.normal_force_N));
  }
  if (conditions.zero_force_N && result.conditions.quantity == ForceQuantity::Force_N) {
    change(1.0, -*conditions.zero_force_N);
  } else if (conditions.zero_force_N) {
    result.warnings.push_back(
        {"zero_force_ignored",
         "a zero force in newtons cannot be subtracted from a friction coefficient without the normal force"});
  }
  if (is_negative_throughout(result.force)) {
    change(-1.0, 0.0);
    result.assumed.emplace_back("The force is negative throughout: its sign was turned.");
  }
  return result;
}

constexpr double kMostBackward = 0.02;
constexpr double kSpeedTolerance = 0.05;

std::string clock_range(const Rows& rows) {
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

/// Errors: time_runs_backwards, window_empty, no_number_in_column, too_few_samples, time_constant.
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
                             counted(rows.time_s.size(), "sample"), clock_range(rows))};
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

/// Counts, assumptions and warnings.
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
                                             plan.window->end_s, clock_range(rows)));
  }
  return provenance;
}

/// A displacement column that moves steadily at another speed than the stated one.
std::optional<Warning> compare_speeds(const Rows& rows, const RowPlan& plan, double stated_m_per_s) {
  if (!plan.choice.displacement || !(stated_m_per_s > 0.0)) return std::nullopt;
  const auto speed_m_per_s = steady_speed_m_per_s(rows.displacement);
  if (!speed_m_per_s || std::abs(*speed_m_per_s - stated_m_per_s) <= kSpeedTolerance * stated_m_per_s)
    return std::nullopt;
  return Warning{"speed_differs_from_displacement",
                 fmt::format("the speed is given as {:.6g} m/s, but {} moves at {:.6g} m/s", stated_m_per_s,
                             describe(plan.layout, plan.choice.displacement->column), *speed_m_per_s)};
}

std::size_t expected_rows(const TextSource& source, const Layout& layout, const ReadOptions& options) {
  if (options.window) return 0;
  return std::min(kMostReserved, static_cast<std::size_t>(1.02 * static_cast<double>(source.estimated_size()) /
                                                          std::max(1.0, layout.mean_line_length)));
}

Result<Recording> build(Rows rows, const RowPlan& plan, const Conditions& conditions, const std::string& file) {
  if (const auto error = check_rows(rows, plan, file)) return *error;
  Provenance provenance = describe_rows(rows, plan, file);
  if (auto warning = compare_speeds(rows, plan, conditions.speed_m_per_s)) {
    provenance.warnings.push_back(*std::move(warning));
  }
  Interpreted force = interpret_force(std::move(rows.force), conditions, plan.choice.force.quantity);
  if (is_reciprocating(force.force)) {
    return Error{"reciprocating",
                 fmt::format("{}: the sign of the force turns with every stroke (a reciprocating test), and one "
                             "stroke is one recording; choose one with --window T0:T1 (in s; from {} to {})",
                             file, rows.time_s.front(), rows.time_s.back())};
  }
  provenance.assumed.insert(provenance.assumed.end(), force.assumed.begin(), force.assumed.end());
  provenance.warnings.insert(provenance.warnings.end(), force.warnings.begin(), force.warnings.end());
  auto recording =
      Recording::create(std::move(rows.time_s), std::move(force.force), force.conditions, std::move(provenance));
  if (!recording) return Error{recording.error().code, file + ": " + recording.error().message};
  return recording;
}

Result<Recording> read_file(const std::filesystem::path& path, const std::string& file, const Conditions& conditions,
                            const ReadOptions& options) {
  if (const auto error = check_options(options, file)) return *error;
  auto opened = TextSource::open(path);
  if (!opened) return opened.error();
  std::unique_ptr<TextSource> source = std::move(opened).value();
  const auto layout = layout_of_head(*source, file);
  if (!layout) return layout.error();
  auto choice = choose_columns(layout.value(), options, file);
  if (!choice) return choice.error();
  Choice chosen = std::move(choice).value();
  if (source->is_utf16()) chosen.assumed.emplace_back("The text is in UTF-16.");
  const RowPlan plan{layout.value(), chosen, options.sample_rate_Hz, options.window,
                     expected_rows(*source, layout.value(), options)};
  return build(read_rows(file, std::move(source), plan), plan, conditions, file);
}

}  // namespace

Result<Recording> read_recording(const std::filesystem::path& file, const Conditions& conditions,
                                 const ReadOptions& options) {
  const std::string name = printable(file.string());
  try {
    return read_file(file, name, conditions, options);
  } catch (const ::io::error::line_length_limit_exceeded& e) {
    return Error{
        "line_too_long",
        fmt::format("{}:{}: the line is longer than 16 MB; is this a text file with a row a line?", name, e.file_line)};
  } catch (const std::bad_alloc&) {
    return Error{"out_of_memory", name + ": not enough memory; read a part with --window"};
  } catch (const std::exception& e) {
    return Error{"not_readable", name + ": reading failed (" + printable(e.what()) + "); check the disk"};
  }
}

}  // namespace slipfit
