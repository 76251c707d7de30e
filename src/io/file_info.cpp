#include "slipfit/io/file_info.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "core/clock_step.hpp"
#include "core/thrown_error.hpp"
#include "io/build.hpp"
#include "io/columns.hpp"
#include "io/message.hpp"
#include "io/opened_file.hpp"
#include "io/part.hpp"
#include "io/steps.hpp"
#include "io/strokes.hpp"

namespace slipfit {
namespace {

using namespace reading;

/// In the order of Role; empty if it is unknown.
constexpr std::array<const char*, 10> kQuantities{
    "", "time", "force", "normal_force", "friction_coefficient", "displacement", "speed", "step", "torque", ""};

std::vector<ColumnInfo> columns_of(const Layout& layout) {
  std::vector<ColumnInfo> columns;
  for (const Column& column : layout.columns) {
    columns.push_back({columns.size() + 1, column.name.base, column.name.unit,
                       kQuantities.at(static_cast<std::size_t>(column.name.role))});
  }
  return columns;
}

/// Returns the text that an option accepts for a column: its name if it is unique, otherwise its number.
std::string option_text(const Layout& layout, std::size_t column) {
  const std::string& name = layout.columns[column].name.text;
  const auto same = std::ranges::count_if(layout.columns, [&](const Column& other) { return other.name.text == name; });
  return name.empty() || same > 1 ? std::to_string(column + 1) : name;
}

TakenColumns taken_columns(const Layout& layout, const Choice& choice) {
  TakenColumns taken;
  if (choice.time) taken.time_column = option_text(layout, choice.time->column);
  taken.force_column = option_text(layout, choice.force.column);
  if (choice.normal_force) taken.normal_force_column = option_text(layout, choice.normal_force->column);
  return taken;
}

std::optional<double> value_of(const std::vector<double>& column, const Step& step) {
  if (column.empty()) return std::nullopt;
  const auto level = level_of(step.of(column));
  return level && level->is_steady ? std::optional(level->value) : std::nullopt;
}

std::vector<StepInfo> infos_of(const Rows& rows, std::span<const Step> steps, bool has_clock) {
  std::vector<StepInfo> infos;
  if (rows.time_s.empty()) return infos;
  for (const Step& step : steps) {
    StepInfo info{step.number, {rows.place_of(step.begin).row, rows.place_of(step.end - 1).row}, {}, {}, {}};
    if (has_clock) info.time_s = TimeWindow{rows.time_s[step.begin], rows.time_s[step.end - 1]};
    info.speed_m_per_s = value_of(rows.speed_m_per_s, step);
    info.normal_force_N = value_of(rows.normal_force_N, step);
    infos.push_back(info);
  }
  return infos;
}

/// Chooses the columns that can be chosen; if none can, any column of numbers, so that rows and steps are still
/// reported.
void choose_for(OpenedFile& file, FileInfo& info) {
  const Layout& layout = file.layout;
  auto chosen = result_of([&] { return choose_columns(layout, file.options, 0.0, file.name); });
  if (chosen) {
    file.choice = std::move(chosen).value();
    info.taken = taken_columns(layout, file.choice);
    return;
  }
  info.refusal = chosen.error();
  const auto numeric = std::ranges::find_if(layout.columns, [](const Column& column) { return column.is_numeric(); });
  if (numeric != layout.columns.end()) {
    file.choice.force.column = static_cast<std::size_t>(numeric - layout.columns.begin());
  }
}

/// The recording that would be read, where it can be; at any speed if no column contains it.
void add_recording(FileInfo& info, Part part, const OpenedFile& file) {
  info.strokes = std::max<std::size_t>(1, find_strokes({part.rows.force, part.rows.displacement_m}).size());
  Conditions conditions;
  conditions.speed_m_per_s = info.taken.speed_m_per_s.value_or(1.0);
  auto recording = result_of([&] { return build_recording(std::move(part), file, conditions); });
  if (recording) {
    info.recording = std::move(recording).value();
  } else {
    info.refusal = recording.error();
  }
}

FileInfo inspect(const Container& container, const std::string& name, const ReadOptions& options) {
  OpenedFile file = open_file(container, name, options);
  FileInfo info;
  info.columns = columns_of(file.layout);
  choose_for(file, info);
  load_rows(file);
  info.rows = file.rows.count;
  const bool has_clock = file.choice.time || options.sample_rate_Hz;
  const std::vector<Step> steps = find_steps(file.rows);
  info.steps = infos_of(file.rows, steps, has_clock);
  info.is_one_recording = file.rows.time_s.empty() || are_one_recording(file.rows, steps);
  info.assumed = file.choice.assumed;
  Part part = take_part(file);
  const Rows& taken = part.rows;
  const double step_s = median_positive_step(taken.time_s);
  if (has_clock && step_s > 0.0) info.sample_rate_Hz = 1.0 / step_s;
  const auto speed = level_of(taken.speed_m_per_s);
  if (speed && speed->is_steady) info.taken.speed_m_per_s = speed->value;
  info.assumed.insert(info.assumed.end(), part.provenance.assumed.begin(), part.provenance.assumed.end());
  if (!info.refusal) add_recording(info, std::move(part), file);
  return info;
}

std::vector<TableInfo> inspect_each(const std::filesystem::path& path, const std::string& name,
                                    const ReadOptions& options) {
  check_options(options, name);
  const Container file = open_container(open_plain(path), name, options);
  std::vector<std::string> names;
  if (!options.sheet && !options.variable) names = file.tables();
  std::vector<TableInfo> tables;
  const auto add = [&](const std::string& table, const std::string& place, const ReadOptions& selected) {
    auto info = with_errors_of_reading(place, [&] {
      FileInfo known = inspect(file, place, selected);
      known.recording.reset();
      return known;
    });
    tables.push_back({table, selected, std::move(info)});
  };
  if (names.empty()) add("", name, options);
  for (const std::string& table : names) {
    ReadOptions selected = options;
    selected.*file.choice = table;
    add(table, name + " ('" + printable_utf8(table) + "')", selected);
  }
  return tables;
}

}  // namespace

Result<FileInfo> inspect_recording(const std::filesystem::path& file, const ReadOptions& options) {
  const std::string name = name_of_file(file);
  return with_errors_of_reading(name, [&] {
    check_options(options, name);
    const Container container = open_container(open_plain(file), name, options);
    FileInfo info = inspect(container, name, options);
    (container.choice == &ReadOptions::sheet ? info.sheets : info.variables) = container.tables();
    return info;
  });
}

Result<std::vector<TableInfo>> inspect_tables(const std::filesystem::path& file, const ReadOptions& options) {
  const std::string name = name_of_file(file);
  return with_errors_of_reading(name, [&] { return inspect_each(file, name, options); });
}

}  // namespace slipfit
