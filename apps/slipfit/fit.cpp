#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

#include "analysis_run.hpp"
#include "commands.hpp"
#include "drafts.hpp"
#include "failure.hpp"
#include "quantities.hpp"
#include "sweep_run.hpp"

namespace {

struct FitArguments {
  AnalysisArguments analysis;
  std::string tier = "auto";
  std::vector<std::string> fixed;
  std::optional<std::string> sweep;  ///< manifest, or the first of several recordings
  std::optional<std::string> group;
  std::vector<std::string> only;
};

/// Recordings of different groups share no parameters: one has to be chosen.
void check_one_group(const FitArguments& arguments, const std::vector<slipfit::ManifestEntry>& entries) {
  if (arguments.group || !arguments.only.empty()) return;
  std::vector<std::string> groups;
  for (const slipfit::ManifestEntry& entry : entries) {
    if (std::find(groups.begin(), groups.end(), entry.group) == groups.end()) groups.push_back(entry.group);
  }
  if (groups.size() < 2) return;
  refuse(
      "{}: contains {} groups ('{}', '{}'{}), but a joint fit needs one: choose it with --group, or recordings with "
      "--only",
      *arguments.sweep, groups.size(), groups[0], groups[1], groups.size() > 2 ? ", ..." : "");
}

/// The manifest says how the recordings of a fit of a sweep were made: only what is not about a recording may be stated
/// beside it.
SweepArguments sweep_arguments(const FitArguments& arguments, const CLI::App& command) {
  static const std::set<std::string> kAllowed{"--joint", "--group",   "--only", "--tier",   "--fix",
                                              "--json",  "--details", "--out",  "--report", "--quiet"};
  for (const CLI::Option* const option : command.get_options()) {
    if (option->count() == 0 || kAllowed.contains(option->get_name())) continue;
    refuse("{} cannot be combined with --joint: the manifest states how each recording was made", option->get_name());
  }
  const std::string name = arguments.group ? *arguments.group : std::filesystem::path(*arguments.sweep).stem().string();
  auto entries = manifest_entries(*arguments.sweep, arguments.group, arguments.only);
  check_one_group(arguments, entries);
  return {name, arguments.analysis.document, *arguments.sweep, std::move(entries)};
}

/// The strokes or segments of one file as a joint fit.
auto fit_together(const slipfit::FitOptions& options, const DocumentOptions& document) {
  return [options, document](const std::vector<slipfit::SweepEntry>& entries) {
    for (const slipfit::SweepEntry& entry : entries) {
      if (const auto error = check_joint(entry.recording)) throw Failure(ExitCode::WrongUsage, *error);
    }
    return analyze_with_progress(entries, options, document);
  };
}

/// Returns the common part of the names.
std::string name_of(const std::vector<slipfit::ManifestEntry>& entries) {
  const std::string& group = entries.front().group;
  const bool is_common = std::all_of(entries.begin(), entries.end(),
                                     [&group](const slipfit::ManifestEntry& entry) { return entry.group == group; });
  return is_common && !group.empty() ? group : fmt::format("{} and {} more", entries.front().id, entries.size() - 1);
}

/// Several recordings that are fitted together, each as the options, its file and its name say.
SweepArguments sweep_of_files(const FitArguments& arguments, const CLI::App& command) {
  std::vector<std::string> files = arguments.analysis.recording.files;
  files.insert(files.begin(), *arguments.sweep);
  for (const char* const single :
       {"--cycles", "--curve", "--plots", "--timing", "--mass", "--sensor-bandwidth", "--sensor-resonance"}) {
    if (command.get_option(single)->count() == 0) continue;
    refuse("{} applies to one recording, but several are fitted together", single);
  }
  const AnalysisArguments& analysis = arguments.analysis;
  const auto draft = draft_of(files, read_options_from(analysis.recording), analysis.document);
  std::vector<slipfit::ManifestEntry> entries = entries_of(draft, analysis.recording, analysis.document);
  return {name_of(entries), analysis.document, {}, std::move(entries)};
}

/// --joint names a manifest, or the first of several recordings.
bool is_joint_of_files(const FitArguments& arguments) {
  return arguments.sweep && !arguments.analysis.recording.files.empty() && !is_manifest(*arguments.sweep);
}

void fit_each(const FitArguments& arguments, const slipfit::FitOptions& options) {
  run_each(arguments.analysis,
           [&options](const slipfit::Recording& recording) { return slipfit::analyze_and_fit(recording, options); });
  arguments.analysis.document.notify(
      "each recording was fitted separately; --joint before the files fits them together with one set of parameters");
}

void run(const FitArguments& arguments, const CLI::App& command) {
  const std::vector<std::string>& files = arguments.analysis.recording.files;
  const bool is_together = arguments.sweep || is_of_pieces(arguments.analysis);
  slipfit::FitOptions options = fit_options_from(arguments.tier, arguments.fixed,
                                                 is_together ? slipfit::FitKind::Sweep : slipfit::FitKind::Single);
  if (is_joint_of_files(arguments)) return run_sweep(sweep_of_files(arguments, command), options);
  if (arguments.sweep) return run_sweep(sweep_arguments(arguments, command), options);
  if (arguments.group || !arguments.only.empty()) {
    refuse("--group and --only select recordings of a manifest: give it with --joint");
  }
  if (files.empty()) refuse("REC is required: name a recording, or a manifest with --joint");
  if (is_of_pieces(arguments.analysis)) {
    return run_pieces(arguments.analysis, fit_together(options, arguments.analysis.document));
  }
  if (files.size() > 1) return fit_each(arguments, options);
  const DocumentOptions& document = arguments.analysis.document;
  options.curve = document.has("--curve") || document.has("--report") || arguments.analysis.plots;
  run_analysis(arguments.analysis, [&options](const slipfit::Recording& recording) {
    return slipfit::analyze_and_fit(recording, options);
  });
}

}  // namespace

void add_fit_command(CLI::App& program, const std::string& typed_line) {
  CLI::App* const command = program.add_subcommand("fit", "Analyses recordings and fits the stick-slip model");
  const auto arguments = std::make_shared<FitArguments>();
  arguments->analysis.document.command_line = typed_line;
  add_analysis_options(*command, arguments->analysis);
  command->get_option("REC")->required(false)->description(
      "Recordings; several are fitted separately (--joint: together)");
  command
      ->add_option("--tier", arguments->tier,
                   "auto|sawtooth|undamped|damped|weakening|velocity: model (velocity: with --joint)")
      ->capture_default_str();
  command->add_option("--fix", arguments->fixed, "NAME=VALUE: fix k, w_n or zeta at a value (SI); may be repeated")
      ->allow_extra_args(false);
  add_output_option(*command, arguments->analysis.document, "--curve",
                    "Write time, force, fitted force and residual (CSV)");
  command->add_option("--surface", arguments->analysis.surface.file,
                      "Profile or image of the worn track; its pattern is compared with the slips");
  add_profile_options(*command, arguments->analysis.surface);
  command
      ->add_option("--joint", arguments->sweep,
                   "Manifest (CSV) or several recordings, fitted with one set of parameters")
      ->check([](const std::string& value) {
        return value.starts_with("--") ? "must be followed by a manifest or recordings; other options come after these"
                                       : "";
      });
  command->add_option("--group", arguments->group, "With --joint: fit this group of the manifest");
  command->add_option("--only", arguments->only, "With --joint: fit these recordings (ID,ID,...)")->delimiter(',');
  command->callback([arguments, command] { run(*arguments, *command); });
}
