#include "slipfit/io/recording_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <new>
#include <utility>

#include "io/columns.hpp"
#include "io/layout.hpp"
#include "io/message.hpp"
#include "io/row_report.hpp"
#include "io/rows.hpp"
#include "io/sign.hpp"
#include "io/text_source.hpp"

namespace slipfit {
namespace {

using namespace reading;

constexpr std::size_t kHead = std::size_t{64} * 1024;
constexpr std::size_t kLongHead = std::size_t{4} * 1024 * 1024;  // for a preamble that fills the first look
constexpr std::size_t kLongestLine = kLongHead / 4;  // that a file without rows of numbers in that look may have
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

Result<Layout> look_at_head(TextSource& source, const std::string& file) {
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
  std::vector<std::string> said;
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
    result.said.push_back(
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
    result.said.emplace_back("The force is negative throughout: its sign was turned.");
  }
  return result;
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
  provenance.assumed.insert(provenance.assumed.end(), force.said.begin(), force.said.end());
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
  const auto layout = look_at_head(*source, file);
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
