#include "analysis_run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <utility>
#include <vector>

#include "drafts.hpp"
#include "failure.hpp"
#include "memory.hpp"
#include "several_documents.hpp"
#include "slipfit/background.hpp"
#include "slipfit/io/recording_reader.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/report/csv.hpp"
#include "slipfit/report/html.hpp"
#include "slipfit/report/json.hpp"
#include "slipfit/report/text.hpp"
#include "slipfit/surface/comparison.hpp"
#include "sweep_run.hpp"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Options that contradict themselves are wrong usage; what depends on the file's content is an error of the recording.
ExitCode exit_code_for(const std::string& error_code) {
  const bool options = error_code == "conflicting_options" || error_code == "bad_window" || error_code == "bad_rows" ||
                       error_code == "bad_sample_rate" || error_code == "no_speed" ||
                       error_code == "speed_contradicted" || error_code == "speed_not_positive";
  return options ? ExitCode::WrongUsage : ExitCode::BadRecording;
}

template <class Value>
Value usable(slipfit::Result<Value> read) {
  const ExitCode exit = read ? ExitCode::Analysed : exit_code_for(read.error().code);
  return value_or_fail(std::move(read), exit);
}

slipfit::Recording read(const AnalysisArguments& arguments) {
  slipfit::ManifestEntry entry = entry_from(arguments.recording);
  if (!arguments.surface.file.empty()) {
    const MeasuredSurface measured = measure(arguments.surface);
    entry.conditions.worn_track =
        std::make_shared<const slipfit::WornTrack>(slipfit::worn_track_of(measured.profile, measured.surface));
  }
  return usable(
      slipfit::with_data(slipfit::read_recording(only_file(arguments.recording), entry.conditions, entry.options)));
}

std::string timing_text(const slipfit::Timing& timing) {
  return fmt::format("\nTiming\n  read {:.4f} s, frequency {:.4f} s, fit {:.4f} s, total {:.4f} s\n", timing.read_s,
                     timing.frequency_s, timing.fit_s, timing.total_s);
}

/// The document, in JSON with this id; empty: that of the recording.
std::string document(const AnalysisArguments& arguments, const std::string& id, const slipfit::Recording& recording,
                     const slipfit::Analysis& analysis) {
  if (arguments.document.json) {
    return slipfit::to_json(recording, analysis, {.id = id, .timing = arguments.timing}) + "\n";
  }
  const auto text =
      arguments.document.details ? slipfit::to_text(recording, analysis) : slipfit::to_summary(recording, analysis);
  return text + (arguments.timing ? timing_text(analysis.timing) : std::string());
}

void write_all_results(const AnalysisArguments& arguments, const slipfit::Recording& recording,
                       const slipfit::Analysis& analysis) {
  slipfit::Background background;
  if (arguments.document.has("--report") || arguments.plots)
    background = slipfit::gather_background(recording, analysis);
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
    write_file({"--plots", (std::filesystem::path(*arguments.plots) / picture.name).string()}, picture.content);
  }
  arguments.document.notify(fmt::format("wrote {} pictures to '{}'", pictures.size(), *arguments.plots));
}

/// The first option that is given and asks for something of one recording alone; empty: none.
std::string option_of_one(const AnalysisArguments& arguments) {
  for (const auto& [option, is_given] : {std::pair{"--cycles", arguments.document.has("--cycles")},
                                         {"--curve", arguments.document.has("--curve")},
                                         {"--plots", arguments.plots.has_value()},
                                         {"--timing", arguments.timing}}) {
    if (is_given) return option;
  }
  return {};
}

void refuse_for_several(const AnalysisArguments& arguments) {
  std::string option = option_of_one(arguments);
  if (arguments.document.has("--report")) option = "--report";
  if (!arguments.surface.file.empty()) option = "--surface";
  if (option.empty()) return;
  refuse(
      "{} applies to one recording, but {} are given; slipfit batch with --out DIR and --report DIR/index.html "
      "writes a page for each",
      option, arguments.recording.files.size());
}

}  // namespace

void add_analysis_options(CLI::App& command, AnalysisArguments& arguments) {
  add_recording_options(command, arguments.recording);
  add_document_options(command, arguments.document, "report");
  command.add_flag("--details", arguments.document.details, "Print all results as text (default: one screen)");
  add_output_option(command, arguments.document, "--cycles", "Write a table of the cycles (CSV)");
  add_report_option(command, arguments.document);
  command.add_option("--plots", arguments.plots, "Write the charts of the report into this folder (SVG)");
  command.add_flag("--timing", arguments.timing, "Add the duration of each stage");
}

void run_analysis(const AnalysisArguments& arguments,
                  const std::function<slipfit::Analysis(const slipfit::Recording&)>& analysis) {
  prepare_memory(only_file(arguments.recording));
  check_outputs(arguments.document.outputs, only_file(arguments.recording));
  if (arguments.plots) make_folder({"--plots", *arguments.plots});
  const Clock::time_point start = Clock::now();
  const slipfit::Recording recording = read(arguments);
  const double read_s = seconds_since(start);
  slipfit::Analysis result = analysis(recording);
  result.timing.read_s = read_s;
  result.timing.total_s = seconds_since(start);
  write_all_results(arguments, recording, result);
}

void run_each(const AnalysisArguments& arguments,
              const std::function<slipfit::Analysis(const slipfit::Recording&)>& analysis) {
  refuse_for_several(arguments);
  for (const std::string& file : arguments.recording.files) check_outputs(arguments.document.outputs, file);
  const slipfit::ManifestDraft draft = slipfit::draft_manifest(
      {arguments.recording.files.begin(), arguments.recording.files.end()}, read_options_from(arguments.recording));
  const auto entries = entries_of(draft, arguments.recording, arguments.document);
  SeveralDocuments documents(entries.size() + draft.skipped.size(), arguments.document.json);
  for (const slipfit::Error& error : draft.skipped) documents.add_failure(ExitCode::BadRecording, error);
  for (const slipfit::ManifestEntry& entry : entries) {
    const auto recording = slipfit::read_recording(entry.file, entry.conditions, entry.options);
    if (!recording) {
      documents.add_failure(exit_code_for(recording.error().code), recording.error());
      continue;
    }
    documents.add(document(arguments, entry.id, recording.value(), analysis(recording.value())));
  }
  documents.write(arguments.document);
}

bool is_of_pieces(const AnalysisArguments& arguments) {
  return read_options_from(arguments.recording).pieces != slipfit::Pieces::One;
}

void run_pieces(const AnalysisArguments& arguments,
                const std::function<slipfit::SweepAnalysis(const std::vector<slipfit::SweepEntry>&)>& analysis) {
  if (const std::string option = option_of_one(arguments); !option.empty()) {
    refuse("{} applies to one recording and cannot be combined with --strokes or --segments", option);
  }
  const std::string& file = only_file(arguments.recording);
  check_outputs(arguments.document.outputs, file);
  const slipfit::ManifestEntry entry = entry_from(arguments.recording);
  const auto pieces = usable(slipfit::read_pieces(file, entry.conditions, entry.options));
  write_sweep(std::filesystem::path(file).stem().string(), arguments.document, pieces, analysis(pieces));
}
