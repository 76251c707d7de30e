#pragma once

#include <string>
#include <vector>

#include "failure.hpp"

/// The outcome of a command; message and code are empty if it succeeded.
struct Outcome {
  ExitCode exit = ExitCode::Analysed;
  std::string message;  ///< one line
  std::string code;     ///< of docs/formats.md
};

/// Runs what the words name: the program's name, then a command and its arguments. `command_line` is shown in reports.
/// Throws nothing.
Outcome run_program(std::vector<std::string> words, const std::string& command_line);
