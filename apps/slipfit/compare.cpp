#include "slipfit/compare.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "commands.hpp"
#include "document_file.hpp"
#include "drafts.hpp"
#include "failure.hpp"
#include "output.hpp"
#include "progress_line.hpp"
#include "slipfit/io/manifest.hpp"
#include "slipfit/io/recording_reader.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/report/comparison.hpp"
#include "slipfit/report/json.hpp"

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

/// One side: what is stated of it, its recordings, and their results.
struct Side {
  std::vector<std::string> paths;
  std::optional<std::string> group{};
  RecordingArguments recording;
  std::vector<ManifestEntry> entries{};  ///< recordings to fit
  slipfit::ComparisonSide result{};
  std::vector<slipfit::ComparedRecording> kept{};  ///< whose cycles a page shows
};

/// One document, or one a line.
bool is_results_file(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return (stream >> std::ws).peek() == '{';
}

void add_results(const std::string& file, Side& side) {
  const std::size_t before = side.result.fits.size();
  const auto add = [&side](const std::string& document, const std::string& place) {
    slipfit::ComparedFit fit = value_or_fail(slipfit::compared_fit(document, place));
    const bool is_joint = fit.id.starts_with("group:");
    if (!is_joint && (!side.group || fit.group == *side.group)) side.result.fits.push_back(std::move(fit));
  };
  if (fs::path(file).extension() == ".jsonl") {
    std::ifstream lines(file, std::ios::binary);
    std::string line;
    for (std::size_t number = 1; std::getline(lines, line); ++number) add(line, fmt::format("{}:{}", file, number));
  } else {
    add(document_text(file), file);
  }
  if (side.result.fits.size() > before) return;
  refuse("'{}': no result{} in it", file, side.group ? " of group '" + *side.group + "'" : "");
}

/// Reads what the paths name. Files and folders of recordings are drafted together, so that --speed may be given once
/// for each.
void gather(Side& side, const DocumentOptions& document) {
  std::vector<std::string> recordings;
  for (const std::string& path : side.paths) {
    std::error_code ignored;
    const std::string log = (fs::path(path) / "results.jsonl").string();
    const bool is_folder = fs::is_directory(path, ignored);
    if (is_folder && fs::exists(log, ignored)) {
      add_results(log, side);
    } else if (!is_folder && is_results_file(path)) {
      add_results(path, side);
    } else if (!is_folder && is_manifest(path)) {
      for (ManifestEntry& entry : manifest_entries(path, side.group, {})) side.entries.push_back(std::move(entry));
    } else {
      recordings.push_back(path);
    }
  }
  if (recordings.empty()) return;
  const auto draft = draft_of(recordings, read_options_from(side.recording), document);
  auto entries = entries_of(draft, side.recording, document);
  if (side.group) {
    std::erase_if(entries, [&side](const ManifestEntry& entry) { return entry.group != *side.group; });
    if (entries.empty()) refuse("--group: no recording of '{}'", *side.group);
  }
  side.entries.insert(side.entries.end(), entries.begin(), entries.end());
}

std::string name_of(const Side& side) {
  if (side.group) return *side.group;
  fs::path path(side.paths.front());
  if (!path.has_filename()) path = path.parent_path();
  const std::string name = path.stem().string();
  return side.paths.size() == 1 ? name : fmt::format("{} and {} more", name, side.paths.size() - 1);
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
void fit(std::array<Side, 2>& sides, const DocumentOptions& document) {
  ProgressLine line;
  std::size_t done = 0;
  const std::size_t total = sides[0].entries.size() + sides[1].entries.size();
  for (Side& side : sides) {
    for (const ManifestEntry& entry : side.entries) {
      if (!document.quiet) line.show(fmt::format("fitting recording {} of {}", ++done, total));
      slipfit::ComparedRecording one = analysed(entry);
      const std::string json = to_json(one.recording, one.analysis, {.id = entry.id});
      side.result.fits.push_back(value_or_fail(slipfit::compared_fit(json, entry.file), ExitCode::BadRecording));
      if (document.has("--report")) side.kept.push_back(std::move(one));
    }
  }
}

/// Paths, group and speed of each side.
std::array<Side, 2> sides_of(const CompareArguments& arguments) {
  Side a{.paths = arguments.files_a, .recording = arguments.recording};
  Side b{.paths = arguments.files_b, .recording = arguments.recording};
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
  return {std::move(a), std::move(b)};
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
  const DocumentOptions& document = arguments.document;
  std::array<Side, 2> sides = sides_of(arguments);
  for (const Side& side : sides) {
    for (const std::string& path : side.paths) check_outputs(document.outputs, path);
  }
  for (Side& side : sides) gather(side, document);
  fit(sides, document);
  for (Side& side : sides) side.result.name = name_of(side);
  const slipfit::Comparison comparison = slipfit::compare(sides[0].result, sides[1].result);
  const slipfit::ComparisonOrigin origin{document.command_line, std::move(sides[0].kept), std::move(sides[1].kept)};
  write_results(document, [&](const std::string& option) {
    if (option == "--report") return to_html(comparison, origin);
    return document.json ? to_json(comparison) + "\n" : to_text(comparison);
  });
}

}  // namespace

void add_compare_command(CLI::App& program, const std::string& typed_line) {
  CompareArguments arguments;
  arguments.document.command_line = typed_line;
  add_command<CompareArguments>(program, "compare", "Compares two recordings, groups of repeats, or results",
                                add_options, run, arguments);
}
