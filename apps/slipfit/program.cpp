#include "program.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <string_view>
#include <utility>

#include "commands.hpp"
#include "slipfit/core/units.hpp"

namespace {

/// The command that the arguments named, for "see slipfit fit --help".
std::string command_line(const CLI::App& program) {
  const auto commands = program.get_subcommands();
  return commands.empty() ? "slipfit" : "slipfit " + commands.front()->get_name();
}

/// CLI11's errors as one line; --help and --version arrive here too and are no errors.
Outcome parse_outcome(const CLI::App& program, const CLI::ParseError& error) {
  if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::Success)) {
    return {ExitCode::WrongUsage, std::string(error.what()) + " (see " + command_line(program) + " --help)",
            "wrong_usage"};
  }
  (void)program.exit(error, std::cout, std::cerr);
  if (std::cout.flush()) return {};
  return {ExitCode::WrongUsage, std::string("cannot write to standard output: ") + std::strerror(errno),
          "cannot_write"};
}

void check_command(const CLI::App& program, const std::string& first_argument) {
  std::string known;
  for (const CLI::App* const command : program.get_subcommands({})) {
    if (command->get_name() == first_argument) return;
    known += (known.empty() ? "" : ", ") + command->get_name();
  }
  if (first_argument.empty()) throw Failure(ExitCode::WrongUsage, "a command is missing: one of " + known);
  if (first_argument.front() == '-') return;
  throw Failure(ExitCode::WrongUsage, "unknown command '" + first_argument + "', expected one of " + known);
}

bool is_unit(const std::string& text) {
  using enum slipfit::Dimension;
  constexpr std::array kDimensions{Time, Length, Speed, Force, Frequency, Mass, AngularSpeed};
  return std::any_of(kDimensions.begin(), kDimensions.end(),
                     [&text](slipfit::Dimension dimension) { return bool(slipfit::parse_unit(text, dimension)); });
}

/// "--speed 10 mm/s" without quotes arrives as three words: a number behind an option and a unit, which no file is
/// called, are one.
std::vector<std::string> with_quantities_joined(const std::vector<std::string>& words) {
  std::vector<std::string> joined;
  for (const std::string& word : words) {
    const bool is_behind_number = joined.size() >= 2 && joined[joined.size() - 2].starts_with("--") &&
                                  joined[joined.size() - 2].find('=') == std::string::npos &&
                                  slipfit::parse_quantity(joined.back(), slipfit::Dimension::Dimensionless) &&
                                  slipfit::unit_in(joined.back()).empty();
    std::error_code error;
    if (is_behind_number && is_unit(word) && !std::filesystem::exists(word, error)) {
      joined.back() += " " + word;
    } else {
      joined.push_back(word);
    }
  }
  return joined;
}

struct Command {
  std::string_view name;
  void (*add)(CLI::App& program, const std::string& typed_line);
};

template <void (*Add)(CLI::App&)>
void without_line(CLI::App& program, const std::string& /*typed_line*/) {
  Add(program);
}

/// In the order of the help.
constexpr std::array kCommands = std::to_array<Command>({
    {"analyze", add_analyze_command},
    {"fit", add_fit_command},
    {"info", without_line<add_info_command>},
    {"simulate", without_line<add_simulate_command>},
    {"predict", without_line<add_predict_command>},
    {"plan", without_line<add_plan_command>},
    {"figures", without_line<add_figures_command>},
    {"compare", add_compare_command},
#ifndef SLIPFIT_SINGLE_PROCESS
    {"batch", without_line<add_batch_command>},
    {"merge", without_line<add_merge_command>},
#endif
    {"manifest", without_line<add_manifest_command>},
    {"surface", add_surface_command},
});

/// Only the command that is called, where one is: all options of all of them would be a fifth of the start-up.
void add_commands(CLI::App& program, const std::string& first_argument, const std::string& typed_line) {
  const auto is_called = [&](const Command& command) { return command.name == first_argument; };
  const bool is_one = std::any_of(kCommands.begin(), kCommands.end(), is_called);
  if (first_argument == "--version") return;
  for (const Command& command : kCommands) {
    if (!is_one || is_called(command)) command.add(program, typed_line);
  }
}

void run(CLI::App& program, std::vector<std::string> words, const std::string& typed_line) {
  program.set_version_flag("--version", std::string("slipfit ") + SLIPFIT_VERSION);
  program.require_subcommand(1);
  program.footer(
      "Exit codes: 0 analysed, 1 some recordings of a batch failed, 2 wrong usage, 3 recording unreadable or without "
      "anything usable.");
  add_commands(program, words.size() > 1 ? words[1] : "", typed_line);
  check_command(program, words.size() > 1 ? words[1] : "");
  words = with_quantities_joined({words.begin() + std::min<std::ptrdiff_t>(1, std::ssize(words)), words.end()});
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  program.parse(std::move(words));
}

}  // namespace

Outcome run_program(std::vector<std::string> words, const std::string& command_line) {
  try {
    CLI::App program("Fits a stick-slip friction model to tribometer recordings", "slipfit");
    try {
      run(program, std::move(words), command_line);
    } catch (const CLI::ParseError& error) {
      return parse_outcome(program, error);
    }
    return {};
  } catch (const Failure& failure) {
    return {failure.exit(), failure.what(), failure.code()};
  } catch (const std::bad_alloc&) {
    return {ExitCode::BadRecording, "not enough memory for this recording: use --window to take a part of it",
            "out_of_memory"};
  } catch (const std::exception& error) {
    return {ExitCode::BadRecording, std::string("internal error, please report it with the recording: ") + error.what(),
            "internal_error"};
  } catch (...) {
    return {ExitCode::BadRecording, "internal error, please report it with the recording", "internal_error"};
  }
}
