#include "io/opened_file.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <utility>

#include "core/thrown_error.hpp"
#include "core/word_list.hpp"
#include "io/columns.hpp"
#include "io/message.hpp"
#include "io/text_lines.hpp"

namespace slipfit::reading {

namespace {

constexpr std::size_t kHead = std::size_t{64} * 1024;
constexpr std::size_t kLongHead = std::size_t{4} * 1024 * 1024;  // for a preamble that fills the first part
constexpr std::size_t kMostShown = 40;
constexpr std::size_t kMostUnreadRows = 3;           // cut-off first lines of a logger
constexpr std::size_t kLongestLine = kLongHead / 4;  // of a file without rows of numbers in its head

/// Errors: comma_twice, rows_before_data.
void check_layout(const std::vector<std::string_view>& lines, const Layout& layout, const std::string& file) {
  const auto shown = [&lines](std::size_t line) { return printable_utf8(lines[line - 1].substr(0, kMostShown)); };
  if (is_comma_twice(lines, layout)) {
    throw ThrownError(
        {"comma_twice", fmt::format("{}:{}: the comma is both the column separator and the decimal sign ('{}'); export "
                                    "with semicolons or tabs between the columns, or with decimal points",
                                    file, layout.first_data_line, shown(layout.first_data_line))});
  }
  const std::vector<std::size_t>& unread = layout.unread_rows;
  if (unread.size() <= kMostUnreadRows) return;
  throw ThrownError({"rows_before_data",
                     fmt::format("{}:{}: {} lines before line {}, where the rows of numbers begin, look like rows but "
                                 "contain text in a column of numbers ('{}'); correct or delete them",
                                 file, unread.front(), unread.size(), layout.first_data_line, shown(unread.front()))});
}

Layout layout_of_head(TextSource& source, const std::string& file) {
  for (const std::size_t size : {kHead, kLongHead}) {
    auto lines = split_lines(source.head(size));
    const std::size_t last_length = lines.empty() ? 0 : lines.back().size();
    if (!source.head_is_everything() && !lines.empty()) lines.pop_back();  // may be cut
    if (auto layout = find_layout(lines)) {
      check_layout(lines, *layout, file);
      return *std::move(layout);
    }
    if (!source.head_is_everything() && last_length > kLongestLine) {
      throw ThrownError({"line_too_long", fmt::format("{}:{}: the line is longer than {} MB, too many columns for a "
                                                      "recording; expected text with a time and a force in each line",
                                                      file, lines.size() + 1, kLongestLine >> 20)});
    }
    if (!source.head_is_everything()) continue;
    const bool is_blank = std::ranges::all_of(lines, [](std::string_view line) { return trim(line).empty(); });
    if (is_blank)
      throw ThrownError({"empty_file", file + ": the file contains only blank lines; export the recording again"});
    break;
  }
  throw ThrownError({"no_numeric_column", file + ": no rows of numbers found; is this the right file? A recording is "
                                                 "text with a column of times and a column of forces"});
}

/// A column of friction coefficients with one of normal forces: their products are the force.
void make_forces(OpenedFile& file) {
  Rows& rows = file.rows;
  Choice& choice = file.choice;
  if (choice.force.quantity != ForceQuantity::FrictionCoefficient || !choice.normal_force) return;
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < rows.force.size(); ++i) {
    rows.force[i] *= rows.normal_force_N[i];
    if (std::isfinite(rows.force[i])) known.push_back(i);
  }
  rows.without_number += rows.force.size() - known.size();
  if (known.size() < rows.force.size()) rows.keep(known);
  choice.force.quantity = ForceQuantity::Force_N;
  choice.assumed.push_back(
      fmt::format("Force is the friction coefficient times {}.", describe(file.layout, choice.normal_force->column)));
}

}  // namespace

OpenedFile open_file(const Container& container, const std::string& name, const ReadOptions& options) {
  OpenedFile file;
  file.name = name;
  file.options = options;
  file.source = TextSource::over(table_in(container, name, options), name);
  file.warnings = file.source->warnings();
  file.layout = layout_of_head(*file.source, file.name);
  return file;
}

void load_rows(OpenedFile& file) {
  const std::vector<std::string>& packed = file.source->assumed();
  file.choice.assumed.insert(file.choice.assumed.begin(), packed.begin(), packed.end());
  file.rows = read_rows(std::move(file.source), file.layout, file.choice, file.options);
  make_forces(file);
}

void check_options(const ReadOptions& options, const std::string& file) {
  if (const auto& window = options.window; window && !(window->begin_s < window->end_s)) {
    throw ThrownError({"bad_window", fmt::format("{}: the window {}:{} s is empty; give T0:T1 in seconds with T0 < T1",
                                                 file, window->begin_s, window->end_s)});
  }
  if (const auto& rows = options.rows; rows && (rows->first < 1 || rows->first >= rows->last)) {
    throw ThrownError({"bad_rows", fmt::format("{}: {}:{} is not a range of rows; give A:B with 1 <= A < B", file,
                                               rows->first, rows->last)});
  }
  if (const auto& rate = options.sample_rate_Hz; rate && !(*rate > 0.0 && std::isfinite(*rate))) {
    throw ThrownError(
        {"bad_sample_rate",
         fmt::format("{}: the sampling rate {} is not a positive number of samples per second; correct --sample-rate",
                     file, *rate)});
  }
}

Error error_of_reading(const std::string& file) {
  try {
    throw;
  } catch (const LineTooLong& e) {
    return {"line_too_long",
            fmt::format("{}:{}: the line is longer than 16 MB; is this a text file with one row per line?", file,
                        e.number)};
  } catch (const ThrownError& e) {
    return e.error();
  } catch (const std::bad_alloc&) {
    return {"out_of_memory", file + ": not enough memory; read a part with --window"};
  } catch (const std::exception& e) {
    return {"not_readable", file + ": reading failed (" + printable_utf8(e.what()) + "); check the disk"};
  }
}

namespace {

void check_samples(const Samples& samples, const ReadOptions& options) {
  check_options(options, samples.name);
  if (samples.time.empty() && !options.sample_rate_Hz) {
    throw ThrownError(
        {"no_time_column",
         fmt::format("{}: the times are missing; give one for each sample, or --sample-rate", samples.name)});
  }
  if (samples.time.empty() || samples.time.size() == samples.force.size()) return;
  throw ThrownError({"length_mismatch", fmt::format("{}: {} times and {} forces, expected equal numbers", samples.name,
                                                    samples.time.size(), samples.force.size())});
}

/// The clock of samples without times.
std::vector<double> even_clock(std::size_t count, double sample_rate_Hz) {
  std::vector<double> time_s(count);
  for (std::size_t i = 0; i < count; ++i) time_s[i] = static_cast<double>(i) / sample_rate_Hz;
  return time_s;
}

void scale_by(std::vector<double>& values, double scale) {
  if (scale == 1.0) return;
  for (double& value : values) value *= scale;
}

}  // namespace

OpenedFile load_samples(Samples samples, const ReadOptions& options) {
  check_samples(samples, options);
  OpenedFile file;
  file.name = samples.name;
  file.options = options;
  file.layout.columns.resize(2);
  file.layout.columns[0].name = {"time", "time", "s", Role::Time, 1};
  file.layout.columns[1].name = {"force", "force", "N", Role::TangentialForce, 1};
  for (Column& column : file.layout.columns) column.numbers = 1;
  ReadOptions units;
  units.time_unit = options.time_unit;
  units.force_unit = options.force_unit;
  units.radius_m = options.radius_m;
  if (samples.time.empty()) units.sample_rate_Hz = options.sample_rate_Hz;
  file.choice = choose_columns(file.layout, units, 0.0, file.name);
  file.choice.assumed.clear();  // all of it is stated
  Rows& rows = file.rows;
  rows.force = std::move(samples.force);
  rows.count = rows.force.size();
  rows.time_s = samples.time.empty() ? even_clock(rows.count, *options.sample_rate_Hz) : std::move(samples.time);
  if (file.choice.time) scale_by(rows.time_s, file.choice.time->scale);
  scale_by(rows.force, file.choice.force.scale);
  rows.keep_wanted(options.rows, options.window);
  return file;
}

}  // namespace slipfit::reading
