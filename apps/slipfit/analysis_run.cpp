#include "analysis_run.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <sys/mman.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <new>
#include <system_error>
#include <vector>

#include "failure.hpp"
#include "output.hpp"
#include "slipfit/background.hpp"
#include "slipfit/io/recording_reader.hpp"
#include "slipfit/report/csv.hpp"
#include "slipfit/report/html.hpp"
#include "slipfit/report/json.hpp"
#include "slipfit/report/text.hpp"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Options that contradict themselves are wrong usage; what depends on the file's content is the recording's fault.
ExitCode exit_code_for(const std::string& error_code) {
  const bool options = error_code == "conflicting_options" || error_code == "bad_window" ||
                       error_code == "bad_sample_rate" || error_code == "speed_not_positive";
  return options ? ExitCode::WrongUsage : ExitCode::BadRecording;
}

slipfit::Recording read(const AnalysisArguments& arguments) {
  const slipfit::Conditions conditions = conditions_from(arguments.recording);
  const slipfit::ReadOptions options = read_options_from(arguments.recording);
  auto recording = slipfit::read_recording(arguments.recording.file, conditions, options);
  if (!recording) throw Failure(exit_code_for(recording.error().code), recording.error().message);
  return std::move(recording).value();
}

std::vector<OutputFile> outputs_of(const AnalysisArguments& arguments) {
  std::vector<OutputFile> outputs;
  if (arguments.out) outputs.push_back({"--out", *arguments.out});
  if (arguments.cycles) outputs.push_back({"--cycles", *arguments.cycles});
  if (arguments.curve) outputs.push_back({"--curve", *arguments.curve});
  if (arguments.report) outputs.push_back({"--report", *arguments.report});
  return outputs;
}

std::string timing_text(const slipfit::Timing& timing) {
  return fmt::format("\nTiming\n  read {:.4f} s, frequency {:.4f} s, fit {:.4f} s, total {:.4f} s\n", timing.read_s,
                     timing.frequency_s, timing.fit_s, timing.total_s);
}

std::string document(const AnalysisArguments& arguments, const slipfit::Recording& recording,
                     const slipfit::Analysis& analysis) {
  if (!arguments.json) {
    return slipfit::to_text(recording, analysis) + (arguments.timing ? timing_text(analysis.timing) : std::string());
  }
  slipfit::JsonOptions options;
  options.timing = arguments.timing;
  return slipfit::to_json(recording, analysis, options) + "\n";
}

std::string content_of(const OutputFile& output, const AnalysisArguments& arguments,
                       const slipfit::Recording& recording, const slipfit::Analysis& analysis,
                       const slipfit::Background& background) {
  if (output.option == "--cycles") return slipfit::cycles_to_csv(recording, analysis);
  if (output.option == "--curve") return slipfit::curve_to_csv(recording, analysis);
  if (output.option != "--report") return document(arguments, recording, analysis);
  const slipfit::ReportOrigin origin{arguments.command_line};
  return slipfit::to_html(recording, analysis, background, origin);
}

void write_pictures(const AnalysisArguments& arguments, const std::vector<slipfit::PictureFile>& pictures) {
  for (const slipfit::PictureFile& picture : pictures) {
    write_file({"--plots", (std::filesystem::path(*arguments.plots) / picture.name).string()}, picture.content);
  }
  if (!arguments.quiet) say(fmt::format("wrote {} pictures to '{}'", pictures.size(), *arguments.plots));
}

void write_results(const AnalysisArguments& arguments, const slipfit::Recording& recording,
                   const slipfit::Analysis& analysis) {
  slipfit::Background background;
  if (arguments.report || arguments.plots) background = slipfit::gather_background(recording, analysis);
  for (const OutputFile& output : outputs_of(arguments)) {
    write_file(output, content_of(output, arguments, recording, analysis, background));
    if (!arguments.quiet) say(fmt::format("wrote '{}'", output.file));
  }
  if (arguments.plots) write_pictures(arguments, slipfit::report_pictures(recording, analysis, background));
  if (arguments.report && !slipfit::has_interactive_trace() && !arguments.quiet) {
    say("this build has no chart library: the report's trace is a picture (build with libjs-dygraphs)");
  }
  if (!arguments.out) write_standard_output(document(arguments, recording, analysis));
}

/// One recording, then the end: what is freed serves the next array and does not go back to the system, and memory
/// comes in huge pages. Every page of 4 kB would be a fault, a quarter of the processor time of a fit of 200 000
/// samples. Not for long recordings, where holes would add up.
void keep_memory_for([[maybe_unused]] const std::string& file) {
#ifdef __GLIBC__
  constexpr std::uintmax_t kLong = std::uintmax_t{64} << 20U;
  constexpr std::size_t kHugePage = std::size_t{2} << 20U;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!(size < kLong)) return;  // of what has no size it is the largest number
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_TOP_PAD, 16 << 20);
  mallopt(M_ARENA_MAX, 1);
  const std::size_t wanted = 8 * static_cast<std::size_t>(size);  // an analysis holds some 60 bytes a sample
  if (wanted < kHugePage) return;
  std::unique_ptr<std::byte[]> room(new (std::nothrow) std::byte[wanted]);  // given back at once, to the heap
  if (!room) return;
  void* begin = room.get();
  std::size_t space = wanted;
  if (std::align(kHugePage, kHugePage, begin, space) == nullptr) return;
  madvise(begin, space, MADV_HUGEPAGE);
#endif
}

}  // namespace

void add_analysis_options(CLI::App& command, AnalysisArguments& arguments) {
  add_recording_options(command, arguments.recording);
  command.add_flag("--json", arguments.json, "One JSON document in place of the report");
  command.add_option("--out", arguments.out, "Write the report or the JSON document to this file");
  command.add_option("--cycles", arguments.cycles, "Write a table of the cycles (CSV)");
  command.add_option("--report", arguments.report, "Write a page to look at and to print (HTML, one file)");
  command.add_option("--plots", arguments.plots, "Write the report's charts into this folder (SVG)");
  command.add_flag("--timing", arguments.timing, "Add the seconds that each stage took");
  command.add_flag("--quiet", arguments.quiet, "No messages on standard error but errors");
}

void run_analysis(const AnalysisArguments& arguments,
                  const std::function<slipfit::Analysis(const slipfit::Recording&)>& analysis) {
  keep_memory_for(arguments.recording.file);
  check_outputs(outputs_of(arguments), arguments.recording.file);
  if (arguments.plots) make_folder({"--plots", *arguments.plots});
  const Clock::time_point start = Clock::now();
  const slipfit::Recording recording = read(arguments);
  const double read_s = seconds_since(start);
  slipfit::Analysis result = analysis(recording);
  result.timing.read_s = read_s;
  result.timing.total_s = seconds_since(start);
  write_results(arguments, recording, result);
}
