#include "analysis_run.hpp"
#include "commands.hpp"

namespace {

void run_analyze(const AnalysisArguments& arguments) {
  if (is_of_pieces(arguments)) return run_pieces(arguments, [](const auto& entries) { return analyze_each(entries); });
  arguments.recording.files.size() > 1 ? run_each(arguments, slipfit::analyze)
                                       : run_analysis(arguments, slipfit::analyze);
}

}  // namespace

void add_analyze_command(CLI::App& program, const std::string& typed_line) {
  AnalysisArguments arguments;
  arguments.document.command_line = typed_line;
  arguments.recording.speed_is_optional = true;
  add_command<AnalysisArguments>(program, "analyze",
                                 "Determines frequency, cycles and kind of motion without fitting a model",
                                 add_analysis_options, run_analyze, arguments);
}
