#include "batch_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <vector>

#include "document_file.hpp"
#include "failure.hpp"
#include "output.hpp"

namespace {

namespace fs = std::filesystem;

/// Returns columns for options that apply to every recording; speed and load fill cells instead.
std::vector<slipfit::DraftColumn> columns_from(const RecordingArguments& options) {
  static const std::set<std::string_view> kFilled{"speed", "radius", "normal_force"};
  std::vector<slipfit::DraftColumn> columns;
  for (const slipfit::RecordingOption& option : given_options(options)) {
    if (kFilled.contains(option.column)) continue;
    if (option.column == "step") {
      throw Failure(ExitCode::WrongUsage, "--step applies to one recording: use slipfit fit");
    }
    const std::string column(option.column);
    columns.push_back({column, options.said.at(column)});
  }
  return columns;
}

bool lies_in(const fs::path& file, const fs::path& folder) {
  std::error_code error;
  const fs::path way = fs::relative(file, folder, error);
  return !error && !way.empty() && *way.begin() != "..";
}

/// Fills the cells; stated values take precedence.
void fill(slipfit::ManifestDraft& draft, const RecordingArguments& options, const Notify& notify) {
  const slipfit::Conditions stated = entry_from(options).conditions;
  for (slipfit::DraftEntry& entry : draft.entries) {
    notify_of_replaced(stated, entry, notify);
    if (stated.speed_m_per_s > 0.0) entry.speed_m_per_s = stated.speed_m_per_s;
    if (stated.normal_force_N) entry.normal_force_N = stated.normal_force_N;
  }
}

std::string manifest_command(const BatchFolder& folder) {
  std::vector<std::string> words{"slipfit", "manifest"};
  words.insert(words.end(), folder.recordings.begin(), folder.recordings.end());
  return shell_line(words);
}

/// Nothing is begun where nothing could be fitted; of some without a speed the results say so.
void check_speeds(const slipfit::ManifestDraft& draft, const BatchFolder& folder, const Notify& notify) {
  const auto without = std::count_if(draft.entries.begin(), draft.entries.end(),
                                     [](const slipfit::DraftEntry& entry) { return !entry.speed_m_per_s; });
  if (without == static_cast<std::ptrdiff_t>(draft.entries.size())) {
    throw Failure(ExitCode::WrongUsage,
                  fmt::format("'{}': no recording has a speed in a column or in its name; give --speed, or draft a "
                              "manifest ({} --out runs.csv) and fill it in",
                              folder.recordings.front(), manifest_command(folder)));
  }
  if (without > 0)
    notify(fmt::format("{} of {} recordings have no speed: give --speed", without, draft.entries.size()));
}

/// The draft of an earlier run stays what its results are of.
void check_same(const std::string& file, const std::string& text) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return;
  if (text_of_file(file) == text) return;
  throw Failure(ExitCode::WrongUsage,
                fmt::format("'{}' exists and differs from the manifest of these files and options: choose another "
                            "--out, or give it as the manifest to continue",
                            file));
}

}  // namespace

std::string drafted_manifest(const BatchFolder& folder, const Notify& notify) {
  const std::vector<slipfit::DraftColumn> columns = columns_from(folder.options);
  slipfit::ManifestDraft draft = draft_of(folder.recordings, read_options_from(folder.options), notify);
  draft.skipped.clear();
  draft = slipfit::writable(std::move(draft));
  for (const slipfit::Error& error : draft.skipped) notify("left out: " + error.message);
  std::erase_if(draft.entries, [&folder](const auto& entry) { return lies_in(entry.file, folder.out); });
  if (draft.entries.empty())
    throw Failure(ExitCode::BadRecording, "no recording found apart from the results in --out");
  fill(draft, folder.options, notify);
  check_speeds(draft, folder, notify);
  make_folder({"--out", folder.out});
  std::string file = (fs::path(folder.out) / "manifest.csv").string();
  const std::string text = slipfit::to_csv(draft, folder.out, columns);
  check_same(file, text);
  write_file({"--out", file}, text);
  notify(fmt::format("drafted the manifest '{}' of {} recordings", file, draft.entries.size()));
  return file;
}

void refuse_recording_options(const RecordingArguments& options) {
  const auto given = given_options(options);
  if (given.empty()) return;
  throw Failure(ExitCode::WrongUsage, fmt::format("{} cannot be combined with a manifest, whose columns state how each "
                                                  "recording was made; it can be combined with a folder",
                                                  given.front().name()));
}
