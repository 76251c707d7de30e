#include "drafts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "failure.hpp"
#include "output.hpp"

namespace {

namespace fs = std::filesystem;

bool is_named(const std::vector<std::string>& paths, const slipfit::Error& error) {
  return std::any_of(paths.begin(), paths.end(), [&error](const std::string& path) {
    std::error_code ignored;
    return !fs::is_directory(path, ignored) && error.message.starts_with(path);
  });
}

/// The one of --speed that is for this recording: its own, or one for all.
std::optional<std::string> speed_for(const RecordingArguments& arguments, std::size_t i, std::size_t recordings) {
  const std::vector<std::string>& speeds = arguments.speeds;
  if (speeds.empty()) return std::nullopt;
  if (speeds.size() == recordings) return speeds[i];
  if (speeds.size() == 1) return speeds.front();
  throw Failure(ExitCode::WrongUsage, fmt::format("--speed is given {} times for {} recordings: give it once, or once "
                                                  "for each in their order",
                                                  speeds.size(), recordings));
}

void take_drafted_speed(double speed_m_per_s, slipfit::ManifestEntry& entry, const Tell& tell) {
  constexpr double kRounding = 0.01;
  double& speed = entry.conditions.speed_m_per_s;
  if (speed > 0.0 && std::abs(speed - speed_m_per_s) > kRounding * speed_m_per_s) {
    tell(
        fmt::format("'{}': {:.4g} m/s by its file or name; one --speed for several is for those that do not tell "
                    "theirs",
                    entry.file.string(), speed_m_per_s));
  }
  speed = speed_m_per_s;
  entry.conditions.speed_unit.clear();
}

[[noreturn]] void refuse_without_speed(const slipfit::DraftEntry& entry) {
  throw Failure(ExitCode::WrongUsage,
                fmt::format("'{}': no speed in a column or in the file's name; give --speed, once for all or once for "
                            "each, or draft a manifest ({} --out runs.csv) and fill it in",
                            entry.file.string(), shell_line({"slipfit", "manifest", entry.file.string()})));
}

}  // namespace

slipfit::ManifestDraft draft_of(const std::vector<std::string>& paths, const slipfit::ReadOptions& options,
                                const Tell& tell) {
  slipfit::ManifestDraft draft = slipfit::draft_manifest({paths.begin(), paths.end()}, options);
  for (const slipfit::Error& error : draft.skipped) {
    if (is_named(paths, error)) throw Failure(ExitCode::BadRecording, error);
  }
  if (draft.entries.empty()) {
    const std::string why = draft.skipped.empty()
                                ? "no files with a usual ending (csv, txt, xlsx, ...) in these folders"
                                : draft.skipped.front().message;
    throw Failure(ExitCode::BadRecording, "no recording found: " + why);
  }
  for (const slipfit::Error& error : draft.skipped) tell("left out: " + error.message);
  return draft;
}

std::vector<slipfit::ManifestEntry> entries_of(const slipfit::ManifestDraft& draft, const RecordingArguments& arguments,
                                               const Tell& tell) {
  std::vector<slipfit::ManifestEntry> entries;
  const std::size_t count = draft.entries.size();
  for (std::size_t i = 0; i < count; ++i) {
    const slipfit::DraftEntry& drafted = draft.entries[i];
    const bool is_stated = arguments.speeds.size() == count;
    slipfit::ManifestEntry entry;
    entry.id = drafted.id;
    entry.file = drafted.file;
    entry.group = drafted.group;
    entry.conditions = conditions_at(arguments, speed_for(arguments, i, count));
    entry.conditions.labels.group = drafted.group;
    entry.options = read_options_from(arguments);
    if (drafted.speed_m_per_s && !is_stated) take_drafted_speed(*drafted.speed_m_per_s, entry, tell);
    if (!entry.conditions.normal_force_N) entry.conditions.normal_force_N = drafted.normal_force_N;
    if (drafted.step) entry.options.step = drafted.step;
    if (!(entry.conditions.speed_m_per_s > 0.0)) refuse_without_speed(drafted);
    entries.push_back(std::move(entry));
  }
  return entries;
}
