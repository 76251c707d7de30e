#include "batch_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include "failure.hpp"
#include "output.hpp"

namespace {

namespace fs = std::filesystem;

/// Options about recordings that were given.
std::vector<const CLI::Option*> given_options(const CLI::App& command) {
  CLI::App all;
  RecordingArguments ignored;
  add_recording_options(all, ignored);
  std::vector<const CLI::Option*> given;
  for (const CLI::Option* const option : all.get_options()) {
    const CLI::Option* const own = command.get_option_no_throw(option->get_name());
    if (own != nullptr && option->get_name() != "--help" && own->count() > 0) given.push_back(own);
  }
  return given;
}

/// "--time-column" is the column time_column.
std::string column_of(const std::string& option) {
  if (option == "--zero") return "zero_force";
  if (option == "--speed-uncertainty") return "speed_se";
  std::string column = option.substr(2);
  std::replace(column.begin(), column.end(), '-', '_');
  return column;
}

/// What goes with every recording; speed and load fill cells instead.
std::vector<slipfit::DraftColumn> columns_from(const CLI::App& command) {
  static const std::set<std::string> kFilled{"--speed", "--radius", "--normal-force"};
  static const std::set<std::string> kNoColumn{"--mass", "--sensor-bandwidth", "--sensor-resonance", "--step"};
  std::vector<slipfit::DraftColumn> columns;
  for (const CLI::Option* const option : given_options(command)) {
    if (kFilled.contains(option->get_name())) continue;
    if (kNoColumn.contains(option->get_name())) {
      throw Failure(ExitCode::WrongUsage, option->get_name() + " belongs to one recording: use slipfit fit");
    }
    columns.push_back({column_of(option->get_name()), option->results().front()});
  }
  return columns;
}

bool lies_in(const fs::path& file, const fs::path& folder) {
  std::error_code error;
  const fs::path way = fs::relative(file, folder, error);
  return !error && !way.empty() && *way.begin() != "..";
}

void fill(slipfit::ManifestDraft& draft, const RecordingArguments& options) {
  const slipfit::Conditions stated = conditions_from(options);
  for (slipfit::DraftEntry& entry : draft.entries) {
    if (!entry.speed_m_per_s && stated.speed_m_per_s > 0.0) entry.speed_m_per_s = stated.speed_m_per_s;
    if (!entry.normal_force_N) entry.normal_force_N = stated.normal_force_N;
  }
}

/// Nothing is begun where nothing could be fitted; of some without a speed the results say so.
void check_speeds(const slipfit::ManifestDraft& draft, const BatchFolder& folder, const Tell& tell) {
  const auto without = std::count_if(draft.entries.begin(), draft.entries.end(),
                                     [](const slipfit::DraftEntry& entry) { return !entry.speed_m_per_s; });
  if (without == static_cast<std::ptrdiff_t>(draft.entries.size())) {
    throw Failure(ExitCode::WrongUsage,
                  fmt::format("'{}': no speed in a column or a name of any recording in this folder; give --speed, or "
                              "draft a manifest ({} --out runs.csv) and fill it in",
                              folder.recordings, shell_line({"slipfit", "manifest", folder.recordings})));
  }
  if (without > 0) tell(fmt::format("{} of {} without a speed: give --speed", without, draft.entries.size()));
}

/// The draft of an earlier run stays what its results are of.
void check_same(const std::string& file, const std::string& text) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return;
  std::ostringstream before;
  before << std::ifstream(file, std::ios::binary).rdbuf();
  if (before.str() == text) return;
  throw Failure(ExitCode::WrongUsage,
                fmt::format("'{}' is there and differs from what would be drafted now (other files or options): choose "
                            "another --out, or go on with it as the manifest in place of the folder",
                            file));
}

}  // namespace

std::string drafted_manifest(const BatchFolder& folder, const CLI::App& command, const Tell& tell) {
  const std::vector<slipfit::DraftColumn> columns = columns_from(command);
  slipfit::ManifestDraft draft = draft_of({folder.recordings}, read_options_from(folder.options), tell);
  std::erase_if(draft.entries, [&folder](const auto& entry) { return lies_in(entry.file, folder.out); });
  if (draft.entries.empty()) throw Failure(ExitCode::BadRecording, "no recording found beside the results in --out");
  fill(draft, folder.options);
  check_speeds(draft, folder, tell);
  make_folder({"--out", folder.out});
  std::string file = (fs::path(folder.out) / "manifest.csv").string();
  const std::string text = slipfit::to_csv(draft, folder.out, columns);
  check_same(file, text);
  write_file({"--out", file}, text);
  tell(fmt::format("drafted the manifest '{}' of {} recordings", file, draft.entries.size()));
  return file;
}

void refuse_recording_options(const CLI::App& command) {
  const auto given = given_options(command);
  if (given.empty()) return;
  throw Failure(
      ExitCode::WrongUsage,
      given.front()->get_name() +
          " does not go with a manifest, whose columns say how each recording was made; it goes with a folder");
}
