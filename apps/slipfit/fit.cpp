// The commands analyze and fit: recordings each on its own, or several with one set of parameters.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "drafts.hpp"
#include "failure.hpp"
#include "memory.hpp"
#include "output.hpp"
#include "progress_line.hpp"
#include "quantities.hpp"
#include "recording_options.hpp"
#include "slipfit/background.hpp"
#include "slipfit/io/recording_reader.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/report/csv.hpp"
#include "slipfit/report/html.hpp"
#include "slipfit/report/json.hpp"
#include "slipfit/report/sweep.hpp"
#include "slipfit/report/sweep_html.hpp"
#include "slipfit/report/text.hpp"
#include "slipfit/surface/comparison.hpp"
#include "slipfit/sweep.hpp"
#include "surface_options.hpp"

using slipfit::ManifestEntry, slipfit::SweepEntry;

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct FitArguments {
  const CLI::App* command = nullptr;  ///< whose options were given
  RecordingArguments recording;
  DocumentOptions document;
  bool timing = false;
  std::optional<std::string> plots;  ///< folder for SVG files
  // Of fit alone.
  bool with_fit = false;
  std::string tier = "auto";
  std::vector<std::string> fixed;
  SurfaceArguments surface;          ///< the worn track; an empty file name: none
  std::optional<std::string> sweep;  ///< manifest, or the first of several recordings
  std::optional<std::string> group;
  std::vector<std::string> only;
};

/// Returns the first of these options that was given; empty: none.
std::string first_given(const FitArguments& arguments, std::initializer_list<const char*> options) {
  const auto* const found = std::find_if(options.begin(), options.end(), [&](const char* name) {
    const CLI::Option* const option = arguments.command->get_option_no_throw(name);
    return option != nullptr && option->count() > 0;
  });
  return found == options.end() ? "" : *found;
}

/// Options that contradict themselves are wrong usage; what depends on the file's content is an error of the recording.
ExitCode exit_code_for(const std::string& error_code) {
  static const std::set<std::string> kOfOptions{"conflicting_options", "bad_window", "bad_rows",
                                                "bad_sample_rate",     "no_speed",   "speed_contradicted",
                                                "speed_not_positive"};
  return kOfOptions.contains(error_code) ? ExitCode::WrongUsage : ExitCode::BadRecording;
}

template <class Value>
Value usable(slipfit::Result<Value> read) {
  const ExitCode exit = read ? ExitCode::Analysed : exit_code_for(read.error().code);
  return value_or_fail(std::move(read), exit);
}

slipfit::Recording read(const FitArguments& arguments) {
  ManifestEntry entry = entry_from(arguments.recording);
  if (!arguments.surface.file.empty()) {
    const MeasuredSurface measured = measure(arguments.surface);
    entry.conditions.worn_track =
        std::make_shared<const slipfit::WornTrack>(slipfit::worn_track_of(measured.profile, measured.surface));
  }
  return usable(
      slipfit::with_data(slipfit::read_recording(only_file(arguments.recording), entry.conditions, entry.options)));
}

slipfit::Analysis analysed(const FitArguments& arguments, const slipfit::Recording& recording,
                           const slipfit::FitOptions& options) {
  return arguments.with_fit ? slipfit::analyze_and_fit(recording, options) : slipfit::analyze(recording);
}

/// The document, in JSON with this id; empty: that of the recording.
std::string document(const FitArguments& arguments, const std::string& id, const slipfit::Recording& recording,
                     const slipfit::Analysis& analysis) {
  if (arguments.document.json) {
    return slipfit::to_json(recording, analysis, {.id = id, .timing = arguments.timing}) + "\n";
  }
  std::string text =
      arguments.document.details ? slipfit::to_text(recording, analysis) : slipfit::to_summary(recording, analysis);
  if (!arguments.timing) return text;
  const slipfit::Timing& timing = analysis.timing;
  return text + fmt::format("\nTiming\n  read {:.4f} s, frequency {:.4f} s, fit {:.4f} s, total {:.4f} s\n",
                            timing.read_s, timing.frequency_s, timing.fit_s, timing.total_s);
}

/// One recording, with every result that was asked for.
void run_one(const FitArguments& arguments, const slipfit::FitOptions& options) {
  const std::string& file = only_file(arguments.recording);
  prepare_memory(file);
  check_outputs(arguments.document.outputs, file);
  if (arguments.plots) make_folder({"--plots", *arguments.plots});
  const Clock::time_point start = Clock::now();
  const auto seconds = [start] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  const slipfit::Recording recording = read(arguments);
  const double read_s = seconds();
  slipfit::Analysis analysis = analysed(arguments, recording, options);
  analysis.timing.read_s = read_s;
  analysis.timing.total_s = seconds();
  slipfit::Background background;
  if (!first_given(arguments, {"--report", "--plots"}).empty()) {
    background = slipfit::gather_background(recording, analysis);
  }
  write_results(arguments.document, [&](const std::string& option) {
    if (option == "--cycles") return slipfit::cycles_to_csv(recording, analysis);
    if (option == "--curve") return slipfit::curve_to_csv(recording, analysis);
    if (option == "--report") {
      return slipfit::to_html(recording, analysis, background, {arguments.document.command_line});
    }
    return document(arguments, {}, recording, analysis);
  });
  if (!arguments.plots) return;
  const auto pictures = slipfit::report_pictures(recording, analysis, background);
  for (const slipfit::PictureFile& picture : pictures) {
    write_file({"--plots", (fs::path(*arguments.plots) / picture.name).string()}, picture.content);
  }
  arguments.document.notify(fmt::format("wrote {} pictures to '{}'", pictures.size(), *arguments.plots));
}

/// Several recordings separately, with text or JSON as the only output.
void run_each(const FitArguments& arguments, const slipfit::FitOptions& options) {
  const std::vector<std::string>& files = arguments.recording.files;
  if (const std::string option =
          first_given(arguments, {"--surface", "--report", "--cycles", "--curve", "--plots", "--timing"});
      !option.empty()) {
    refuse(
        "{} applies to one recording, but {} are given; slipfit batch with --out DIR and --report DIR/index.html "
        "writes a page for each",
        option, files.size());
  }
  for (const std::string& file : files) check_outputs(arguments.document.outputs, file);
  const slipfit::ManifestDraft draft =
      slipfit::draft_manifest({files.begin(), files.end()}, read_options_from(arguments.recording));
  const auto entries = entries_of(draft, arguments.recording, arguments.document);
  const std::size_t skipped = draft.skipped.size();
  const auto document_of = [&](std::size_t i) -> slipfit::Result<std::string> {
    if (i < skipped) return draft.skipped[i];
    const ManifestEntry& entry = entries[i - skipped];
    const auto recording = slipfit::read_recording(entry.file, entry.conditions, entry.options);
    if (!recording) return recording.error();
    return document(arguments, entry.id, recording.value(), analysed(arguments, recording.value(), options));
  };
  write_each(arguments.document, skipped + entries.size(), document_of, exit_code_for);
  if (!arguments.with_fit) return;
  arguments.document.notify(
      "each recording was fitted separately; --joint before the files fits them together with one set of parameters");
}

/// Analyses recordings together and writes their document, whose id is `name`. The steps are shown on a terminal: some
/// seconds for a dozen recordings.
void run_together(const FitArguments& arguments, slipfit::FitOptions options, const std::string& name,
                  const std::vector<SweepEntry>& entries) {
  const DocumentOptions& document = arguments.document;
  slipfit::SweepAnalysis sweep;
  if (arguments.with_fit) {
    ProgressLine line;
    if (!document.quiet) options.notify_step = [&line](const std::string& step) { line.show(step); };
    sweep = slipfit::analyze_sweep(entries, options);
  } else {
    sweep = slipfit::analyze_each(entries);
  }
  write_results(document, [&](const std::string& option) {
    if (option == "--report") {
      return to_html(entries, sweep, predict_around(entries, sweep), {name, document.command_line});
    }
    if (document.json) return slipfit::to_json(entries, sweep, {.id = name}) + "\n";
    return document.details ? slipfit::to_text(entries, sweep, name) : slipfit::to_summary(entries, sweep, name);
  });
}

/// The strokes or segments of one file.
void run_pieces(const FitArguments& arguments, const slipfit::FitOptions& options) {
  if (const std::string option = first_given(arguments, {"--cycles", "--curve", "--plots", "--timing"});
      !option.empty()) {
    refuse("{} applies to one recording and cannot be combined with --strokes or --segments", option);
  }
  const std::string& file = only_file(arguments.recording);
  check_outputs(arguments.document.outputs, file);
  const ManifestEntry entry = entry_from(arguments.recording);
  const std::vector<SweepEntry> pieces = usable(slipfit::read_pieces(file, entry.conditions, entry.options));
  for (const SweepEntry& piece : arguments.with_fit ? pieces : std::vector<SweepEntry>{}) {
    if (const auto error = check_joint(piece.recording)) throw Failure(ExitCode::WrongUsage, *error);
  }
  run_together(arguments, options, fs::path(file).stem().string(), pieces);
}

/// Recordings that are fitted together, under the name of their document.
void run_sweep(const FitArguments& arguments, const slipfit::FitOptions& options, const std::string& name,
               const std::vector<ManifestEntry>& manifest) {
  for (const ManifestEntry& entry : manifest) check_outputs(arguments.document.outputs, entry.file.string());
  auto entries = slipfit::read_sweep(manifest);
  const bool manifest_asks_for_it = !entries && entries.error().code == "view_not_spring";
  run_together(arguments, options, name,
               value_or_fail(std::move(entries), manifest_asks_for_it ? ExitCode::WrongUsage : ExitCode::BadRecording));
}

/// The recordings of a manifest, which says how they were made: only what is not about a recording may be stated beside
/// it. Recordings of different groups share no parameters: one has to be chosen.
void run_manifest(const FitArguments& arguments, const slipfit::FitOptions& options) {
  static const std::set<std::string> kAllowed{"--joint", "--group",   "--only", "--tier",   "--fix",
                                              "--json",  "--details", "--out",  "--report", "--quiet"};
  for (const CLI::Option* const option : arguments.command->get_options()) {
    if (option->count() == 0 || kAllowed.contains(option->get_name())) continue;
    refuse("{} cannot be combined with --joint: the manifest states how each recording was made", option->get_name());
  }
  const std::vector<ManifestEntry> entries = manifest_entries(*arguments.sweep, arguments.group, arguments.only);
  std::vector<std::string> groups;
  for (const ManifestEntry& entry : entries) {
    if (std::ranges::find(groups, entry.group) == groups.end()) groups.push_back(entry.group);
  }
  if (groups.size() > 1 && !arguments.group && arguments.only.empty()) {
    refuse(
        "{}: contains {} groups ('{}', '{}'{}), but a joint fit needs one: choose it with --group, or recordings with "
        "--only",
        *arguments.sweep, groups.size(), groups[0], groups[1], groups.size() > 2 ? ", ..." : "");
  }
  check_outputs(arguments.document.outputs, *arguments.sweep);
  run_sweep(arguments, options, arguments.group.value_or(fs::path(*arguments.sweep).stem().string()), entries);
}

/// --group and --only choose among the rows of a manifest.
void check_no_selection(const FitArguments& arguments) {
  if (!arguments.group && arguments.only.empty()) return;
  refuse("--group and --only select recordings of a manifest: give it with --joint");
}

/// Several recordings that are fitted together, each as the options, its file and its name say.
void run_files_together(const FitArguments& arguments, const slipfit::FitOptions& options) {
  check_no_selection(arguments);
  std::vector<std::string> files = arguments.recording.files;
  files.insert(files.begin(), *arguments.sweep);
  if (const std::string option = first_given(arguments, {"--cycles", "--curve", "--plots", "--timing", "--mass",
                                                         "--sensor-bandwidth", "--sensor-resonance"});
      !option.empty()) {
    refuse("{} applies to one recording, but several are fitted together: leave it out, or leave out --joint", option);
  }
  const auto draft = draft_of(files, read_options_from(arguments.recording), arguments.document);
  const std::vector<ManifestEntry> entries = entries_of(draft, arguments.recording, arguments.document);
  const std::string& group = entries.front().group;
  const bool is_common = !group.empty() && std::ranges::all_of(entries, [&group](const ManifestEntry& entry) {
    return entry.group == group;
  });
  run_sweep(arguments, options,
            is_common ? group : fmt::format("{} and {} more", entries.front().id, entries.size() - 1), entries);
}

void run(const FitArguments& arguments) {
  const std::vector<std::string>& files = arguments.recording.files;
  const bool is_of_pieces = !arguments.sweep && read_options_from(arguments.recording).pieces != slipfit::Pieces::One;
  const bool is_together = arguments.sweep || is_of_pieces;
  slipfit::FitOptions options = fit_options_from(arguments.tier, arguments.fixed,
                                                 is_together ? slipfit::FitKind::Sweep : slipfit::FitKind::Single);
  options.curve = !first_given(arguments, {"--curve", "--report", "--plots"}).empty();
  if (arguments.sweep) {  // a manifest, or the first of the recordings
    const std::string& first = *arguments.sweep;
    const bool is_of_manifest =
        files.empty() ? names_manifest({first}, read_options_from(arguments.recording)) : is_manifest(first);
    return is_of_manifest ? run_manifest(arguments, options) : run_files_together(arguments, options);
  }
  check_no_selection(arguments);
  if (files.empty()) refuse("REC is required: name a recording, or a manifest with --joint");
  if (is_of_pieces) return run_pieces(arguments, options);
  files.size() > 1 ? run_each(arguments, options) : run_one(arguments, options);
}

void add_analysis_options(CLI::App& command, FitArguments& arguments) {
  arguments.command = &command;
  add_recording_options(command, arguments.recording);
  add_document_options(command, arguments.document, "report");
  command.add_flag("--details", arguments.document.details, "Print all results as text (default: one screen)");
  add_output_option(command, arguments.document, "--cycles", "Write a table of the cycles (CSV)");
  add_report_option(command, arguments.document);
  command.add_option("--plots", arguments.plots, "Write the charts of the report into this folder (SVG)");
  command.add_flag("--timing", arguments.timing, "Add the duration of each stage");
}

void add_fit_options(CLI::App& command, FitArguments& arguments) {
  add_analysis_options(command, arguments);
  arguments.with_fit = true;
  command.get_option("REC")->required(false)->description(
      "Recordings; several are fitted separately (--joint: together)");
  command
      .add_option("--tier", arguments.tier,
                  "auto|sawtooth|undamped|damped|weakening|velocity: model (velocity: with --joint)")
      ->capture_default_str();
  command
      .add_option("--fix", arguments.fixed,
                  "NAME=VALUE: fix k, w_n or zeta at a value, such as k=5kN/m; may be repeated")
      ->allow_extra_args(false);
  add_output_option(command, arguments.document, "--curve", "Write time, force, fitted force and residual (CSV)");
  command.add_option("--surface", arguments.surface.file,
                     "Profile or image of the worn track; its pattern is compared with the slips");
  add_profile_options(command, arguments.surface);
  command
      .add_option("--joint", arguments.sweep,
                  "Manifest (CSV), recordings or a folder, fitted with one set of parameters")
      ->check([](const std::string& value) {
        return value.starts_with("--") ? "must be followed by a manifest or recordings; other options come after these"
                                       : "";
      });
  command.add_option("--group", arguments.group, "With --joint: fit this group of the manifest");
  command.add_option("--only", arguments.only, "With --joint: fit these recordings (ID,ID,...)")->delimiter(',');
}

}  // namespace

void add_analyze_command(CLI::App& program, const std::string& typed_line) {
  FitArguments arguments;
  arguments.document.command_line = typed_line;
  arguments.recording.speed_is_optional = true;
  add_command<FitArguments>(program, "analyze",
                            "Determines frequency, cycles and kind of motion without fitting a model",
                            add_analysis_options, run, arguments);
}

void add_fit_command(CLI::App& program, const std::string& typed_line) {
  FitArguments arguments;
  arguments.document.command_line = typed_line;
  add_command<FitArguments>(program, "fit", "Analyses recordings and fits the stick-slip model", add_fit_options, run,
                            arguments);
}
