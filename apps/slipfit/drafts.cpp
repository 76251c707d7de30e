#include "drafts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "failure.hpp"
#include "output.hpp"
#include "slipfit/io/file_info.hpp"
#include "slipfit/io/manifest.hpp"

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
  refuse("--speed is given {} times for {} recordings: give it once, or once for each in their order", speeds.size(),
         recordings);
}

bool differ(double stated, double drafted) {
  constexpr double kRounding = 0.01;
  return std::abs(stated - drafted) > kRounding * drafted;
}

}  // namespace

bool is_manifest(const std::string& file) {
  return slipfit::ManifestReader::open(file).ok();
}

bool names_manifest(const std::vector<std::string>& paths, const slipfit::ReadOptions& options) {
  std::error_code ignored;
  const std::string& first = paths.front();
  if (paths.size() > 1 || fs::is_directory(first, ignored)) return false;
  if (!fs::is_regular_file(first, ignored) || is_manifest(first)) return true;  // a pipe is not waited for
  const auto recording = slipfit::inspect_recording(first, options);
  return !recording || recording.value().refusal;
}

std::vector<slipfit::ManifestEntry> manifest_entries(const std::string& manifest,
                                                     const std::optional<std::string>& group,
                                                     const std::vector<std::string>& only) {
  std::vector<slipfit::ManifestEntry> entries = value_or_fail(slipfit::read_manifest_group(manifest, group));
  if (only.empty()) return entries;
  std::vector<slipfit::ManifestEntry> chosen;
  for (const std::string& id : only) {
    const auto entry = std::ranges::find(entries, id, &slipfit::ManifestEntry::id);
    if (entry == entries.end()) {
      refuse("{}: no recording '{}'{}, named by --only", manifest, id, group ? " in group '" + *group + "'" : "");
    }
    chosen.push_back(*entry);
  }
  return chosen;
}

void notify_of_replaced(const slipfit::Conditions& stated, const slipfit::DraftEntry& drafted,
                        const DocumentOptions& document) {
  const std::string file = drafted.file.string();
  const double speed_m_per_s = stated.speed_m_per_s;
  if (drafted.speed_m_per_s && speed_m_per_s > 0.0 && differ(speed_m_per_s, *drafted.speed_m_per_s)) {
    document.notify(
        fmt::format("'{}': the file or its name states {:.4g} m/s, but --speed states {:.4g} m/s, which is used", file,
                    *drafted.speed_m_per_s, speed_m_per_s));
  }
  const auto& load_N = stated.normal_force_N;
  if (drafted.normal_force_N && load_N && differ(*load_N, *drafted.normal_force_N)) {
    document.notify(
        fmt::format("'{}': the file or its name states a normal force of {:.4g} N, but --normal-force states {:.4g} N, "
                    "which is used",
                    file, *drafted.normal_force_N, *load_N));
  }
}

/// Says which speeds and loads nobody stated.
void notify_of_drafted(const std::vector<std::string>& speeds_m_per_s, const std::vector<std::string>& loads_N,
                       const DocumentOptions& document) {
  std::string found;
  if (!speeds_m_per_s.empty()) found = fmt::format("speeds of {} m/s", fmt::join(speeds_m_per_s, ", "));
  if (!loads_N.empty()) {
    found += fmt::format("{}normal forces of {} N", found.empty() ? "" : " and ", fmt::join(loads_N, ", "));
  }
  if (!found.empty()) document.notify("from the columns or names of the files: " + found);
}

void check_found(const slipfit::ManifestDraft& draft) {
  if (!draft.entries.empty()) return;
  const std::string why = draft.skipped.empty() ? "no files with a usual ending (csv, txt, xlsx, ...) in these folders"
                                                : draft.skipped.front().message;
  throw Failure(ExitCode::BadRecording, "no recording found: " + why);
}

slipfit::ManifestDraft draft_of(const std::vector<std::string>& paths, const slipfit::ReadOptions& options,
                                const DocumentOptions& document) {
  slipfit::ManifestDraft draft = slipfit::draft_manifest({paths.begin(), paths.end()}, options);
  for (const slipfit::Error& error : draft.skipped) {
    if (is_named(paths, error)) throw Failure(ExitCode::BadRecording, error);
  }
  check_found(draft);
  for (const slipfit::Error& error : draft.skipped) document.notify("left out: " + error.message);
  return draft;
}

std::vector<slipfit::ManifestEntry> entries_of(const slipfit::ManifestDraft& draft, const RecordingArguments& arguments,
                                               const DocumentOptions& document) {
  std::vector<slipfit::ManifestEntry> entries;
  std::vector<std::string> speeds, loads;
  const std::size_t count = draft.entries.size();
  for (std::size_t i = 0; i < count; ++i) {
    const slipfit::DraftEntry& drafted = draft.entries[i];
    const std::optional<std::string> stated = speed_for(arguments, i, count);
    const bool is_filled = !stated && drafted.speed_m_per_s;
    slipfit::ManifestEntry entry = entry_at(arguments, is_filled ? fmt::format("{}", *drafted.speed_m_per_s) : stated);
    notify_of_replaced(entry.conditions, drafted, document);
    entry.id = drafted.id;
    entry.file = drafted.file;
    entry.group = drafted.group;
    entry.conditions.labels.group = drafted.group;
    if (!entry.conditions.normal_force_N) entry.conditions.normal_force_N = drafted.normal_force_N;
    if (drafted.step) entry.options.step = drafted.step;
    if (drafted.sheet) entry.options.sheet = drafted.sheet;
    if (drafted.variable) entry.options.variable = drafted.variable;
    if (!(entry.conditions.speed_m_per_s > 0.0) && !arguments.speed_is_optional) {
      refuse(
          "'{}': no speed in a column or in the file's name; give --speed, once for all or once for each, or draft a "
          "manifest ({} --out runs.csv) and fill it in",
          drafted.file.string(), manifest_command({drafted.file.string()}));
    }
    if (is_filled) speeds.push_back(fmt::format("{:.4g}", entry.conditions.speed_m_per_s));
    if (drafted.normal_force_N && entry.conditions.normal_force_N == drafted.normal_force_N) {
      loads.push_back(fmt::format("{:.4g}", *drafted.normal_force_N));
    }
    entries.push_back(std::move(entry));
  }
  notify_of_drafted(speeds, loads, document);
  return entries;
}
