#include "slipfit/compare.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "commands.hpp"
#include "document_file.hpp"
#include "drafts.hpp"
#include "failure.hpp"
#include "output.hpp"
#include "progress_line.hpp"
#include "slipfit/io/recording_reader.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/report/comparison.hpp"
#include "slipfit/report/json.hpp"
#include "sweep_run.hpp"

namespace {

namespace fs = std::filesystem;
using slipfit::ManifestEntry;

struct CompareArguments {
  std::vector<std::string> sides;  ///< A and B, or one source with two groups
  std::vector<std::string> files_a, files_b;
  std::vector<std::string> groups;
  RecordingArguments recording;
  DocumentOptions document;
};

/// The arguments of one side.
struct SideArguments {
  std::vector<std::string> paths;
  std::optional<std::string> group;
  RecordingArguments recording;
};

/// A side before its recordings are fitted.
struct Source {
  slipfit::ComparisonSide side;
  std::vector<ManifestEntry> entries;
};

/// One document, or one a line.
bool is_results_file(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return (stream >> std::ws).peek() == '{';
}

void add_fit(const std::string& document, const std::string& place, const SideArguments& arguments, Source& source) {
  slipfit::ComparedFit fit = value_or_fail(slipfit::compared_fit(document, place));
  const bool is_joint = fit.id.starts_with("group:");
  if (is_joint || (arguments.group && fit.group != *arguments.group)) return;
  source.side.fits.push_back(std::move(fit));
}

void add_results(const std::string& file, const SideArguments& arguments, Source& source) {
  const std::size_t before = source.side.fits.size();
  const bool is_log = fs::path(file).extension() == ".jsonl";
  if (!is_log) add_fit(document_text(file), file, arguments, source);
  std::ifstream lines(file, std::ios::binary);
  std::string line;
  for (std::size_t number = 1; is_log && std::getline(lines, line); ++number) {
    add_fit(line, fmt::format("{}:{}", file, number), arguments, source);
  }
  if (source.side.fits.size() > before) return;
  refuse("'{}': no result{} in it", file, arguments.group ? " of group '" + *arguments.group + "'" : "");
}

/// Files and folders of recordings are drafted together, so that --speed may be given once for each.
Source source_of(const SideArguments& arguments, const DocumentOptions& document) {
  Source source;
  std::vector<std::string> recordings;
  for (const std::string& path : arguments.paths) {
    std::error_code ignored;
    const std::string log = (fs::path(path) / "results.jsonl").string();
    const bool is_folder = fs::is_directory(path, ignored);
    if (is_folder && fs::exists(log, ignored)) {
      add_results(log, arguments, source);
    } else if (!is_folder && is_results_file(path)) {
      add_results(path, arguments, source);
    } else if (!is_folder && is_manifest(path)) {
      for (ManifestEntry& entry : manifest_entries(path, arguments.group, {}))
        source.entries.push_back(std::move(entry));
    } else {
      recordings.push_back(path);
    }
  }
  if (!recordings.empty()) {
    const auto draft = draft_of(recordings, read_options_from(arguments.recording), document);
    auto entries = entries_of(draft, arguments.recording, document);
    if (arguments.group) {
      std::erase_if(entries, [&](const ManifestEntry& entry) { return entry.group != *arguments.group; });
      if (entries.empty()) refuse("--group: no recording of '{}'", *arguments.group);
    }
    source.entries.insert(source.entries.end(), entries.begin(), entries.end());
  }
  return source;
}

std::string name_of(const SideArguments& arguments) {
  if (arguments.group) return *arguments.group;
  fs::path path(arguments.paths.front());
  if (!path.has_filename()) path = path.parent_path();
  const std::string name = path.stem().string();
  return arguments.paths.size() == 1 ? name : fmt::format("{} and {} more", name, arguments.paths.size() - 1);
}

slipfit::ComparedRecording analysed(const ManifestEntry& entry) {
  auto recording = slipfit::with_data(slipfit::read_recording(entry.file, entry.conditions, entry.options));
  if (!recording) {
    const slipfit::Error error = entry.line > 0 ? slipfit::in_words_of_manifest(recording.error()) : recording.error();
    throw Failure(ExitCode::BadRecording, error);
  }
  slipfit::Analysis analysis = slipfit::analyze_and_fit(recording.value());
  return {std::move(recording).value(), std::move(analysis)};
}

/// Fits the recordings of both sides; keeps them where a page shows their cycles.
class Fitting {
 public:
  Fitting(const CompareArguments& arguments, std::size_t total) : arguments_(arguments), total_(total) {}

  std::vector<slipfit::ComparedRecording> fit(Source& source) {
    std::vector<slipfit::ComparedRecording> kept;
    for (const ManifestEntry& entry : source.entries) {
      if (!arguments_.document.quiet) line_.show(fmt::format("fitting recording {} of {}", ++done_, total_));
      slipfit::ComparedRecording one = analysed(entry);
      source.side.fits.push_back(
          value_or_fail(slipfit::compared_fit(to_json(one.recording, one.analysis, {.id = entry.id}), entry.file),
                        ExitCode::BadRecording));
      if (arguments_.document.has("--report")) kept.push_back(std::move(one));
    }
    return kept;
  }

 private:
  const CompareArguments& arguments_;
  std::size_t total_ = 0;
  std::size_t done_ = 0;
  ProgressLine line_;
};

/// Paths, group and speed of each side.
std::pair<SideArguments, SideArguments> sides_of(const CompareArguments& arguments) {
  SideArguments a{arguments.files_a, {}, arguments.recording};
  SideArguments b{arguments.files_b, {}, arguments.recording};
  const std::vector<std::string>& sides = arguments.sides;
  const bool has_two_groups = arguments.groups.size() == 2;
  if (!sides.empty()) a.paths.insert(a.paths.begin(), sides.front());
  if (sides.size() > 1 || (has_two_groups && !sides.empty())) b.paths.insert(b.paths.begin(), sides.back());
  if (a.paths.empty() || b.paths.empty()) {
    refuse(
        "two sides are compared: give A and B, or --a FILE... --b FILE..., or one source with two groups "
        "(--group A --group B)");
  }
  if (!arguments.groups.empty()) a.group = arguments.groups.front();
  if (!arguments.groups.empty()) b.group = arguments.groups.back();
  if (const std::vector<std::string>& speeds = arguments.recording.speeds; speeds.size() == 2) {
    a.recording.speeds = {speeds.front()};
    b.recording.speeds = {speeds.back()};
  } else if (speeds.size() > 2) {
    refuse("--speed: give it once for both sides, or twice, for A and for B");
  }
  return {a, b};
}

void add_options(CLI::App& command, CompareArguments& arguments) {
  add_recording_options(command, arguments.recording);
  command.remove_option(command.get_option("REC"));
  command
      .add_option("SIDES", arguments.sides,
                  "A and B: each a recording, a folder or manifest of repeats, or a result of fit --json or batch")
      ->expected(0, 2);
  command.add_option("--a", arguments.files_a, "Further recordings or results of A");
  command.add_option("--b", arguments.files_b, "Further recordings or results of B");
  command.add_option("--group", arguments.groups, "Group of the manifest or results; give it twice, for A and B")
      ->expected(1, 2)
      ->allow_extra_args(false);
  add_document_options(command, arguments.document, "text");
  add_report_option(command, arguments.document);
}

void run(const CompareArguments& arguments) {
  const auto [side_a, side_b] = sides_of(arguments);
  for (const SideArguments* const side : {&side_a, &side_b}) {
    for (const std::string& path : side->paths) check_outputs(arguments.document.outputs, path);
  }
  Source a = source_of(side_a, arguments.document);
  Source b = source_of(side_b, arguments.document);
  slipfit::ComparisonOrigin origin;
  origin.command_line = arguments.document.command_line;
  {
    Fitting fitting(arguments, a.entries.size() + b.entries.size());
    origin.recordings_a = fitting.fit(a);
    origin.recordings_b = fitting.fit(b);
  }
  a.side.name = name_of(side_a);
  b.side.name = name_of(side_b);
  const slipfit::Comparison comparison = slipfit::compare(a.side, b.side);
  write_results(arguments.document, [&](const std::string& option) {
    if (option == "--report") return to_html(comparison, origin);
    return arguments.document.json ? to_json(comparison) + "\n" : to_text(comparison);
  });
}

}  // namespace

void add_compare_command(CLI::App& program, const std::string& typed_line) {
  CompareArguments arguments;
  arguments.document.command_line = typed_line;
  add_command<CompareArguments>(program, "compare", "Compares two recordings, groups of repeats, or results",
                                add_options, run, arguments);
}
