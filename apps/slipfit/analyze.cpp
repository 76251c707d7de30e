#include <memory>

#include "analysis_run.hpp"
#include "commands.hpp"

void add_analyze_command(CLI::App& program, const std::string& command_line) {
  CLI::App* const command =
      program.add_subcommand("analyze", "Determines frequency, cycles and kind of motion without fitting a model");
  const auto arguments = std::make_shared<AnalysisArguments>();
  arguments->command_line = command_line;
  arguments->recording.speed_is_optional = true;
  add_analysis_options(*command, *arguments);
  command->callback([arguments] {
    if (is_of_pieces(*arguments))
      return run_pieces(*arguments, [](const auto& entries) { return analyze_each(entries); });
    arguments->recording.files.size() > 1 ? run_each(*arguments, slipfit::analyze)
                                          : run_analysis(*arguments, slipfit::analyze);
  });
}
