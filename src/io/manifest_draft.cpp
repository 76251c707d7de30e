#include "slipfit/io/manifest_draft.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <fstream>
#include <regex>
#include <set>
#include <system_error>

#include "core/csv_line.hpp"
#include "core/word_list.hpp"
#include "io/file_name.hpp"
#include "io/message.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/core/units.hpp"
#include "slipfit/io/file_info.hpp"

namespace slipfit::reading {

namespace {

constexpr std::size_t kLongestName = 255;

/// Returns a matched number and unit as a quantity, or nothing.
std::optional<double> quantity_in(const std::smatch& match, const std::string& unit, Dimension dimension) {
  std::string number = match[1];
  std::ranges::replace(number, ',', '.');
  const auto value = parse_quantity(number + unit, dimension);
  return value && value.value() > 0.0 ? std::optional(value.value()) : std::nullopt;
}

/// Signs that part words do so once, and neither begin nor end the name.
std::string tidy(const std::string& name) {
  static const std::regex parted("[-_ .]*([-_ .])");
  const std::string single = std::regex_replace(name, parted, "$1");
  const std::size_t begin = single.find_first_not_of("-_ .");
  return begin == std::string::npos ? std::string() : single.substr(begin, single.find_last_not_of("-_ .") + 1 - begin);
}

}  // namespace

FileNameParts read_file_name(const std::string& stem) {
  static const std::regex speed(
      "(?:[vV]-?)?(\\d+(?:[.,]\\d+)?) ?(nm|um|mm|cm|m)(?:_?per_?|p|[-_/ ])?(s|sec|min)(?![A-Za-z0-9])");
  static const std::regex load("(?:^|[-_ ])(?:[fF]n?-?)?(\\d+(?:[.,]\\d+)?) ?(mN|N|kN|g|kg|gf)(?![A-Za-z0-9])");
  static const std::regex repeat("[-_ ](?:run|rep|test|nr|no)?[-_ ]?\\d{1,3}$");
  FileNameParts parts;
  if (stem.size() > kLongestName) return parts;
  std::string rest = stem;
  std::smatch match;
  if (std::regex_search(rest, match, speed)) {
    parts.speed_m_per_s = quantity_in(match, match[2].str() + "/" + match[3].str(), Dimension::Speed);
    rest = match.prefix().str() + match.suffix().str();
  }
  if (std::regex_search(stem, match, load)) parts.normal_force_N = quantity_in(match, match[2], Dimension::Force);
  parts.group = tidy(std::regex_replace(tidy(rest), repeat, ""));
  return parts;
}

}  // namespace slipfit::reading

namespace slipfit {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostSteps = 50;

bool has_usual_ending(const fs::path& file) {
  static const std::set<std::string> kEndings{".csv", ".txt",  ".tsv", ".dat", ".asc",  ".lvm", ".gz",
                                              ".zip", ".xlsx", ".mat", ".h5",  ".hdf5", ".tdms"};
  return kEndings.contains(lower(file.extension().string()));
}

/// In the order of their names: that of the file system differs between machines.
std::vector<fs::path> files_below(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return {path};
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator at(path, fs::directory_options::skip_permission_denied, error), end;
       !error && at != end; at.increment(error)) {
    if (at->is_regular_file(error) && has_usual_ending(at->path())) files.push_back(at->path());
  }
  std::ranges::sort(files);
  return files;
}

std::string stem_of(const fs::path& file) {
  fs::path stem = file.stem();
  if (lower(file.extension().string()) == ".gz") stem = stem.stem();
  return stem.string();
}

/// A name of a table as part of an id: "/runs/7" becomes "runs-7".
std::string id_part(std::string name) {
  name.erase(0, std::min(name.find_first_not_of('/'), name.size()));
  for (char& c : name) {
    if (c == '/' || c == '\\' || static_cast<unsigned char>(c) < 0x20) c = '-';
  }
  return slipfit::printable(name);
}

/// One for each recording in a table; `table` is empty where the file is one.
std::vector<DraftEntry> entries_of(const fs::path& file, const TableInfo& table, const FileInfo& info) {
  const std::string stem = slipfit::printable(stem_of(file));
  reading::FileNameParts parts = reading::read_file_name(stem);
  std::string id = stem;
  if (!table.name.empty()) {
    id += "-" + id_part(table.name);
    const reading::FileNameParts own = reading::read_file_name(id_part(table.name));
    if (own.speed_m_per_s) parts.speed_m_per_s = own.speed_m_per_s;
    if (own.normal_force_N) parts.normal_force_N = own.normal_force_N;
  }
  const bool are_steps = info.steps.size() > 1 && info.steps.size() <= kMostSteps && !info.is_one_recording;
  std::vector<DraftEntry> entries;
  for (std::size_t i = 0; i < (are_steps ? info.steps.size() : 1); ++i) {
    DraftEntry entry{id, file, parts.speed_m_per_s, parts.normal_force_N, parts.group, {}};
    if (!table.name.empty()) {
      entry.sheet = table.options.sheet;
      entry.variable = table.options.variable;
    }
    const bool is_step = are_steps && i < info.steps.size();
    if (is_step) {
      entry.step = info.steps[i].step;
      entry.id += fmt::format("-step{}", *entry.step);
    }
    const auto speed_m_per_s = is_step ? info.steps[i].speed_m_per_s : info.taken.speed_m_per_s;
    if (speed_m_per_s) entry.speed_m_per_s = speed_m_per_s;
    if (info.taken.normal_force_column && !info.steps.empty() && info.steps[i].normal_force_N) {
      entry.normal_force_N = info.steps[i].normal_force_N;
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

/// Returns true for files that slipfit wrote: a table of a batch or of cycles, a curve, a prediction, a manifest.
bool is_of_slipfit(const fs::path& file) {
  constexpr auto kBeginnings = std::to_array<std::string_view>(
      {"row,id,group,file,status,", "id,code,message", "id,file,speed_m_per_s", "cycle,peak_s,trough_s,",
       "time_s,force_N,fitted_N,residual_N", "time_s,force_coefficient,fitted_coefficient,residual_coefficient",
       "speed_m_per_s,regime,bistable,lambda,"});
  constexpr std::size_t kLongest = 128;
  std::string start(kLongest, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(stream.gcount()));
  return std::ranges::any_of(kBeginnings, [&](std::string_view beginning) { return start.starts_with(beginning); });
}

/// The tables of a file of which recordings may be made; of the others `draft.skipped` says why. One of several that
/// would be refused as it is, is none, unless all are.
std::vector<TableInfo> recordings_in(const fs::path& file, const ReadOptions& options, ManifestDraft& draft) {
  auto inspected = inspect_tables(file, options);
  if (!inspected) {
    draft.skipped.push_back(inspected.error());
    return {};
  }
  std::vector<TableInfo> tables = std::move(inspected).value();
  const bool any_is_read =
      std::ranges::any_of(tables, [](const TableInfo& table) { return table.info && !table.info.value().refusal; });
  std::vector<TableInfo> taken;
  for (TableInfo& table : tables) {
    if (!table.info) {
      draft.skipped.push_back(table.info.error());
    } else if (table.info.value().refusal && any_is_read) {
      draft.skipped.push_back(*table.info.value().refusal);
    } else {
      taken.push_back(std::move(table));
    }
  }
  if (tables.size() == 1 && taken.size() == 1) taken.front().name.clear();
  return taken;
}

std::string number_cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : std::string();
}

}  // namespace

ManifestDraft draft_manifest(const std::vector<fs::path>& paths, const ReadOptions& options) {
  ManifestDraft draft;
  std::set<std::string> ids;
  for (const fs::path& path : paths) {
    for (const fs::path& file : files_below(path)) {
      if (file != path && is_of_slipfit(file)) continue;
      for (const TableInfo& table : recordings_in(file, options, draft)) {
        for (DraftEntry& entry : entries_of(file, table, table.info.value())) {
          const std::string id = entry.id;
          for (int copy = 2; !ids.insert(entry.id).second; ++copy) entry.id = fmt::format("{}-{}", id, copy);
          draft.entries.push_back(std::move(entry));
        }
      }
    }
  }
  return draft;
}

ManifestDraft writable(ManifestDraft draft) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7F'; };
  std::erase_if(draft.entries, [&](const DraftEntry& entry) {
    if (std::ranges::none_of(entry.file.string(), is_control)) return false;
    draft.skipped.push_back({"bad_id", slipfit::printable(entry.file.string()) +
                                           ": the name contains a line end or another control character, which a "
                                           "manifest cannot contain; rename the file"});
    return true;
  });
  return draft;
}

std::string to_csv(const ManifestDraft& draft, const fs::path& folder, const std::vector<DraftColumn>& columns) {
  const auto has = [&](auto DraftEntry::*member) {
    return std::ranges::any_of(draft.entries, [&](const DraftEntry& entry) { return (entry.*member).has_value(); });
  };
  const bool has_steps = has(&DraftEntry::step);
  const bool has_sheets = has(&DraftEntry::sheet);
  const bool has_variables = has(&DraftEntry::variable);
  std::vector<std::string> names{"id", "file", "speed_m_per_s", "normal_force_N", "group"};
  if (has_sheets) names.emplace_back("sheet");
  if (has_variables) names.emplace_back("variable");
  if (has_steps) names.emplace_back("step");
  for (const DraftColumn& column : columns) names.push_back(column.name);
  std::string text = csv_line(names) + "\n";
  for (const DraftEntry& entry : draft.entries) {
    std::error_code error;
    fs::path file = fs::proximate(entry.file, folder.empty() ? fs::path(".") : folder, error);
    if (error) file = entry.file;
    std::vector<std::string> cells{spreadsheet_cell(entry.id), (is_formula(file.string()) ? "./" : "") + file.string(),
                                   number_cell(entry.speed_m_per_s), number_cell(entry.normal_force_N),
                                   spreadsheet_cell(entry.group)};
    if (has_sheets) cells.push_back(entry.sheet.value_or(""));
    if (has_variables) cells.push_back(entry.variable.value_or(""));
    if (has_steps) cells.push_back(entry.step ? std::to_string(*entry.step) : std::string());
    for (const DraftColumn& column : columns) cells.push_back(column.cell);
    text += csv_line(cells) + "\n";
  }
  return text;
}

}  // namespace slipfit
