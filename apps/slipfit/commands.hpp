#pragma once

#include <CLI/CLI.hpp>
#include <string>

// Each adds one command to the program; the command runs when the arguments name it, and throws Failure where it
// cannot. `command_line`: as typed, shown in reports.
void add_analyze_command(CLI::App& program, const std::string& command_line);
void add_compare_command(CLI::App& program, const std::string& command_line);
void add_batch_command(CLI::App& program);
void add_fit_command(CLI::App& program, const std::string& command_line);
void add_figures_command(CLI::App& program);
void add_info_command(CLI::App& program);
void add_simulate_command(CLI::App& program);
void add_manifest_command(CLI::App& program);
void add_surface_command(CLI::App& program, const std::string& command_line);
void add_merge_command(CLI::App& program);
void add_predict_command(CLI::App& program);
void add_plan_command(CLI::App& program);
