#include "slipfit/io/manifest_draft.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <system_error>

#include "core/csv_line.hpp"
#include "core/word_list.hpp"
#include "io/file_name.hpp"
#include "io/message.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/io/file_info.hpp"

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

/// One for each recording in the file.
std::vector<DraftEntry> entries_of(const fs::path& file, const FileInfo& info) {
  const std::string stem = slipfit::printable(stem_of(file));
  const reading::ToldByName told = reading::read_file_name(stem);
  const bool are_steps = info.steps.size() > 1 && info.steps.size() <= kMostSteps && !info.is_one_recording;
  std::vector<DraftEntry> entries;
  for (std::size_t i = 0; i < (are_steps ? info.steps.size() : 1); ++i) {
    DraftEntry entry{stem, file, told.speed_m_per_s, told.normal_force_N, told.group, {}};
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

std::string number_cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : std::string();
}

}  // namespace

ManifestDraft draft_manifest(const std::vector<fs::path>& paths, const ReadOptions& options) {
  ManifestDraft draft;
  std::set<std::string> ids;
  for (const fs::path& path : paths) {
    for (const fs::path& file : files_below(path)) {
      const auto info = inspect_recording(file, options);
      if (!info) draft.skipped.push_back(info.error());
      if (!info) continue;
      for (DraftEntry& entry : entries_of(file, info.value())) {
        const std::string id = entry.id;
        for (int copy = 2; !ids.insert(entry.id).second; ++copy) entry.id = fmt::format("{}-{}", id, copy);
        draft.entries.push_back(std::move(entry));
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
                                           ": the name has a line end or another control character, which a manifest "
                                           "cannot hold; rename the file"});
    return true;
  });
  return draft;
}

std::string to_csv(const ManifestDraft& draft, const fs::path& folder, const std::vector<DraftColumn>& columns) {
  const bool has_steps =
      std::ranges::any_of(draft.entries, [](const DraftEntry& entry) { return entry.step.has_value(); });
  std::vector<std::string> names{"id", "file", "speed_m_per_s", "normal_force_N", "group"};
  if (has_steps) names.emplace_back("step");
  for (const DraftColumn& column : columns) names.push_back(column.name);
  std::string text = csv_line(names) + "\n";
  for (const DraftEntry& entry : draft.entries) {
    std::error_code error;
    fs::path file = fs::proximate(entry.file, folder.empty() ? fs::path(".") : folder, error);
    if (error) file = entry.file;
    const bool is_formula = std::string_view("=+-@").find(file.string().front()) != std::string_view::npos;
    std::vector<std::string> cells{spreadsheet_cell(entry.id), (is_formula ? "./" : "") + file.string(),
                                   number_cell(entry.speed_m_per_s), number_cell(entry.normal_force_N),
                                   spreadsheet_cell(entry.group)};
    if (has_steps) cells.push_back(entry.step ? std::to_string(*entry.step) : std::string());
    for (const DraftColumn& column : columns) cells.push_back(column.cell);
    text += csv_line(cells) + "\n";
  }
  return text;
}

}  // namespace slipfit
