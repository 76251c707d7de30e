#include "slipfit/batch/batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <string>

#include "commands.hpp"
#include "core/counted.hpp"
#include "drafts.hpp"
#include "failure.hpp"
#include "output.hpp"
#include "progress_line.hpp"
#include "quantities.hpp"
#include "recording_options.hpp"
#include "stop_signals.hpp"

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostJobs = 1024;

struct BatchArguments {
  std::vector<std::string> paths;
  std::string manifest;          ///< the one that is named, or drafted of the paths
  std::size_t left_out = 0;      ///< of what is named or in the folders
  RecordingArguments recording;  ///< of files and folders
  std::string out;
  std::optional<std::size_t> jobs;
  double timeout_s = 600.0;
  std::optional<std::string> shard;
  bool resume = false;
  bool joint_groups = false;
  std::string tier = "auto";
  std::vector<std::string> fixed;
  std::optional<std::string> report;
  DocumentOptions messages;
};

void add_options(CLI::App& command, BatchArguments& arguments) {
  add_recording_options(command, arguments.recording);
  command.remove_option(command.get_option("REC"));
  command
      .add_option("MANIFEST", arguments.paths,
                  "CSV with the columns id,file,speed_m_per_s, one row for each recording; or recordings and folders, "
                  "whose manifest is drafted into --out")
      ->required();
  command.add_option("--out", arguments.out, "Folder of the results; created if it does not exist")->required();
  command.add_option("--jobs", arguments.jobs,
                     "Number of recordings fitted in parallel; default: one for each available core");
  add_quantity(command, "--timeout", arguments.timeout_s, slipfit::Dimension::Time, Limits::AboveZero,
               "Time limit for a recording, after which it counts as failed")
      ->default_str("10min");
  command.add_flag("--resume", arguments.resume, "Continue the batch in this folder");
  command.add_option("--shard", arguments.shard, "I/N: fit the I-th of N parts of the manifest, I from 1");
  command.add_flag("--joint-groups", arguments.joint_groups, "Also fit the recordings of each group together");
  command.add_option("--tier", arguments.tier, "auto|sawtooth|undamped|damped|weakening: model")->capture_default_str();
  command
      .add_option("--fix", arguments.fixed, "NAME=VALUE: fix a parameter at a value, such as k=5kN/m; may be repeated")
      ->allow_extra_args(false);
  command.add_option(
      "--report", arguments.report,
      "Page of the batch (HTML, such as DIR/index.html); the pages of the recordings are written to the same folder");
  add_quiet_option(command, arguments.messages);
}

slipfit::Shard shard_from(const std::string& text) {
  slipfit::Shard shard;
  const char* const end = text.data() + text.size();
  const auto index = std::from_chars(text.data(), end, shard.index);
  const bool has_slash = index.ec == std::errc() && index.ptr != end && *index.ptr == '/';
  const auto count = has_slash ? std::from_chars(index.ptr + 1, end, shard.count) : index;
  const bool is_whole = has_slash && count.ec == std::errc() && count.ptr == end;
  if (is_whole && shard.index >= 1 && shard.index <= shard.count) return shard;
  refuse("--shard: bad '{}', expected I/N with I from 1 to N (Slurm: --array=1-N)", text);
}

std::size_t jobs_from(const std::optional<std::size_t>& jobs) {
  if (!jobs) return slipfit::default_jobs();
  if (*jobs >= 1 && *jobs <= kMostJobs) return *jobs;
  refuse("--jobs: {} is out of range, expected 1 to {}", *jobs, kMostJobs);
}

/// The command on the pages: what changes the results, so that the pages do not depend on the rest.
slipfit::BatchReport report_from(const BatchArguments& arguments) {
  std::vector<std::string> words{"slipfit", "batch", arguments.manifest};
  if (arguments.tier != "auto") words.insert(words.end(), {"--tier", arguments.tier});
  for (const std::string& fixed : arguments.fixed) words.insert(words.end(), {"--fix", fixed});
  if (arguments.joint_groups) words.emplace_back("--joint-groups");
  return {*arguments.report, shell_line(words)};
}

slipfit::BatchOptions options_from(const BatchArguments& arguments) {
  slipfit::BatchOptions options;
  options.manifest = arguments.manifest;
  options.folder = arguments.out;
  options.fit = fit_options_from(arguments.tier, arguments.fixed, slipfit::FitKind::Single);
  options.jobs = jobs_from(arguments.jobs);
  options.timeout_s = arguments.timeout_s;
  options.resume = arguments.resume;
  if (arguments.shard) options.shard = shard_from(*arguments.shard);
  if (arguments.report) options.report = report_from(arguments);
  if (arguments.joint_groups) options.fit_group = slipfit::group_fit(options.fit, options.report);
  return options;
}

slipfit::BatchOutcome run_shown(const slipfit::BatchOptions& options, const BatchArguments& arguments) {
  ProgressLine line;
  slipfit::BatchHooks hooks;
  hooks.should_stop = [] { return StopSignals::received().has_value(); };
  hooks.should_suspend = StopSignals::take_suspension;
  if (!arguments.messages.quiet) {
    hooks.show_progress = [&line](const slipfit::BatchProgress& progress) { line.show(progress); };
    hooks.notify = say;
  }
  return value_or_fail(slipfit::run_batch(options, hooks));
}

/// Returns columns for options that apply to every recording; speed and load fill cells instead.
std::vector<slipfit::DraftColumn> columns_from(const RecordingArguments& options) {
  static const std::set<std::string_view> kFilled{"speed", "radius", "normal_force"};
  std::vector<slipfit::DraftColumn> columns;
  for (const slipfit::RecordingOption& option : given_options(options)) {
    if (kFilled.contains(option.column)) continue;
    if (option.column == "step") refuse("--step applies to one recording: use slipfit fit");
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
void fill(slipfit::ManifestDraft& draft, const RecordingArguments& options, const DocumentOptions& messages) {
  const slipfit::Conditions stated = entry_from(options).conditions;
  for (slipfit::DraftEntry& entry : draft.entries) {
    notify_of_replaced(stated, entry, messages);
    if (stated.speed_m_per_s > 0.0) entry.speed_m_per_s = stated.speed_m_per_s;
    if (stated.normal_force_N) entry.normal_force_N = stated.normal_force_N;
  }
}

/// Nothing is begun where nothing could be fitted; of some without a speed the results say so.
void check_speeds(const slipfit::ManifestDraft& draft, const BatchArguments& arguments) {
  const auto without = std::count_if(draft.entries.begin(), draft.entries.end(),
                                     [](const slipfit::DraftEntry& entry) { return !entry.speed_m_per_s; });
  if (without == static_cast<std::ptrdiff_t>(draft.entries.size())) {
    refuse(
        "'{}': no recording has a speed in a column or in its name; give --speed, or draft a manifest ({} --out "
        "runs.csv) and fill it in",
        arguments.paths.front(), manifest_command(arguments.paths));
  }
  if (without > 0) {
    arguments.messages.notify(
        fmt::format("{} of {} recordings have no speed: give --speed", without, draft.entries.size()));
  }
}

/// The draft of an earlier run stays what its results are of.
void check_same(const std::string& file, const std::string& text) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return;
  std::ifstream stream(file, std::ios::binary);
  if (std::string(std::istreambuf_iterator<char>(stream), {}) == text) return;
  refuse(
      "'{}' exists and differs from the manifest of these files and options: choose another --out, or give it as the "
      "manifest to continue",
      file);
}

/// Drafts the manifest of the recordings as `slipfit manifest` does, with what the options state, into the folder of
/// the results; returns its file.
std::string drafted_manifest(BatchArguments& arguments) {
  const DocumentOptions& messages = arguments.messages;
  const std::vector<slipfit::DraftColumn> columns = columns_from(arguments.recording);
  slipfit::ManifestDraft draft = draft_of(arguments.paths, read_options_from(arguments.recording), messages);
  arguments.left_out = draft.skipped.size();
  draft.skipped.clear();
  draft = slipfit::writable(std::move(draft));
  arguments.left_out += draft.skipped.size();
  for (const slipfit::Error& error : draft.skipped) messages.notify("left out: " + error.message);
  std::erase_if(draft.entries, [&arguments](const auto& entry) { return lies_in(entry.file, arguments.out); });
  if (draft.entries.empty())
    throw Failure(ExitCode::BadRecording, "no recording found apart from the results in --out");
  fill(draft, arguments.recording, messages);
  check_speeds(draft, arguments);
  make_folder({"--out", arguments.out});
  std::string file = (fs::path(arguments.out) / "manifest.csv").string();
  const std::string text = slipfit::to_csv(draft, arguments.out, columns);
  check_same(file, text);
  write_file({"--out", file}, text);
  messages.notify(fmt::format("drafted the manifest '{}' of {} recordings", file, draft.entries.size()));
  return file;
}

/// A manifest as it is; that of files and folders is drafted first.
BatchArguments with_manifest(BatchArguments arguments) {
  if (arguments.report) {
    if (fs::path(*arguments.report).extension().empty()) refuse_report_name(*arguments.report);
    check_report_name(*arguments.report);
  }
  if (names_manifest(arguments.paths)) {
    if (const auto given = given_options(arguments.recording); !given.empty()) {
      refuse(
          "{} cannot be combined with a manifest, whose columns state how each recording was made; it can be combined "
          "with a folder",
          given.front().name());
    }
    arguments.manifest = arguments.paths.front();
    return arguments;
  }
  for (const std::string& path : arguments.paths) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored) || !is_manifest(path)) continue;
    refuse("'{}' is a manifest: give it alone, or give only recordings and folders", path);
  }
  if (arguments.shard) {
    refuse("--shard: the shards need one manifest, draft it first ({} --out runs.csv)",
           manifest_command(arguments.paths));
  }
  arguments.manifest = drafted_manifest(arguments);
  return arguments;
}

void run(const BatchArguments& stated) {
  const BatchArguments arguments = with_manifest(stated);
  const slipfit::BatchOptions options = options_from(arguments);
  const StopSignals signals;
  const slipfit::BatchOutcome outcome = run_shown(options, arguments);
  const slipfit::BatchProgress& progress = outcome.progress;
  const std::size_t done = progress.before + progress.fitted;
  if (outcome.end == slipfit::BatchEnd::Stopped) {
    throw Failure(StopSignals::received().value_or(ExitCode::Interrupted),
                  fmt::format("stopped after {} of {} recordings; --resume continues", done, progress.total));
  }
  const std::string left_out =
      arguments.left_out > 0 ? "; left out, see above: " + slipfit::counted(arguments.left_out, "file") : "";
  if (progress.failed > 0) {
    throw Failure(ExitCode::RecordingsFailed,
                  fmt::format("{} of {} recordings failed: the reasons are in '{}'{}", progress.failed, progress.total,
                              (options.folder / "failures.csv").string(), left_out));
  }
  arguments.messages.notify(
      fmt::format("wrote {} results to '{}' in {:.3g} s{}", done, arguments.out, progress.seconds, left_out));
}

}  // namespace

void add_batch_command(CLI::App& program, const std::string& /*typed_line*/) {
  add_command<BatchArguments>(
      program, "batch",
      "Fits every recording of a manifest, or of files and folders, and writes the results into a folder", add_options,
      run);
}
