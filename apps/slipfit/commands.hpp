#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

// Each adds one command to the program; the command runs when the arguments name it, and throws Failure where it
// cannot. `typed_line`: the command line as typed, shown in reports.
void add_analyze_command(CLI::App& program, const std::string& typed_line);
void add_compare_command(CLI::App& program, const std::string& typed_line);
void add_batch_command(CLI::App& program, const std::string& typed_line);
void add_fit_command(CLI::App& program, const std::string& typed_line);
void add_figures_command(CLI::App& program, const std::string& typed_line);
void add_info_command(CLI::App& program, const std::string& typed_line);
void add_simulate_command(CLI::App& program, const std::string& typed_line);
void add_manifest_command(CLI::App& program, const std::string& typed_line);
void add_surface_command(CLI::App& program, const std::string& typed_line);
void add_merge_command(CLI::App& program, const std::string& typed_line);
void add_predict_command(CLI::App& program, const std::string& typed_line);
void add_plan_command(CLI::App& program, const std::string& typed_line);

/// Adds a command whose options fill the arguments with which it runs.
template <class Arguments>
void add_command(CLI::App& program, const std::string& name, const std::string& help,
                 void (*add_options)(CLI::App&, Arguments&), void (*run)(const Arguments&),
                 Arguments initial = Arguments{}) {
  CLI::App* const command = program.add_subcommand(name, help);
  const auto arguments = std::make_shared<Arguments>(std::move(initial));
  add_options(*command, *arguments);
  command->callback([arguments, run] { run(*arguments); });
}
