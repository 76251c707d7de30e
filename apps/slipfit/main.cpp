#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "failure.hpp"
#include "output.hpp"
#include "slipfit/core/units.hpp"

namespace {

int code_of(ExitCode exit) {
  return static_cast<int>(exit);
}

/// The command that the arguments named, for "see slipfit fit --help".
std::string command_line(const CLI::App& program) {
  const auto commands = program.get_subcommands();
  return commands.empty() ? "slipfit" : "slipfit " + commands.front()->get_name();
}

/// CLI11's errors as one line; --help and --version arrive here too and are no errors.
int report_parse_result(const CLI::App& program, const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
    const int code = program.exit(error, std::cout, std::cerr);
    if (std::cout.flush()) return code;
    say(std::string("cannot write to standard output: ") + std::strerror(errno));
    return code_of(ExitCode::WrongUsage);
  }
  say(std::string(error.what()) + " (see " + command_line(program) + " --help)");
  return code_of(ExitCode::WrongUsage);
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

int run(int argc, char** argv) {
  CLI::App program("Fits a stick-slip friction model to tribometer recordings", "slipfit");
  program.set_version_flag("--version", std::string("slipfit ") + SLIPFIT_VERSION);
  program.require_subcommand(1);
  program.footer(
      "Exit codes: 0 analysed, 1 some recordings of a batch failed, 2 wrong usage, 3 recording unreadable or without "
      "anything usable.");
  const std::string typed_line = shell_line({argv, argv + argc});
  add_analyze_command(program, typed_line);
  add_fit_command(program, typed_line);
  add_info_command(program);
  add_simulate_command(program);
  add_predict_command(program);
  add_plan_command(program);
  add_figures_command(program);
  add_compare_command(program, typed_line);
  add_batch_command(program);
  add_manifest_command(program);
  add_merge_command(program);
  add_surface_command(program, typed_line);
  try {
    check_command(program, argc > 1 ? argv[1] : "");
    std::vector<std::string> words = with_quantities_joined({argv + std::min(argc, 1), argv + argc});
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    program.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    return report_parse_result(program, error);
  } catch (const Failure& failure) {
    say(failure.what());
    return code_of(failure.exit());
  }
  return code_of(ExitCode::Analysed);
}

/// A file that the program opens would take the number of a closed standard stream, and messages would run into it.
/// Standard output is opened so that writing fails: a result that nobody can read is an error.
void open_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) >= 0) continue;
    (void)::open("/dev/null", descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY);  // the lowest free number
  }
}

}  // namespace

int main(int argc, char** argv) {
  (void)std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is an error like a full disk
  open_standard_streams();
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    say("not enough memory for this recording: use --window to take a part of it");
  } catch (const std::exception& error) {
    say(std::string("internal error, please report it with the recording: ") + error.what());
  } catch (...) {
    say("internal error, please report it with the recording");
  }
  return code_of(ExitCode::BadRecording);
}
