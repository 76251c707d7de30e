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
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "slipfit/core/units.hpp"
#include "slipfit/io/manifest_entry.hpp"

namespace {

/// The command that the arguments named, for "see slipfit fit --help".
std::string command_line(const CLI::App& program) {
  const auto commands = program.get_subcommands();
  return commands.empty() ? "slipfit" : "slipfit " + commands.front()->get_name();
}

/// Changes of single letters that turn one text into the other.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (const char letter : a) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (letter == b[j] ? 0U : 1U);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

/// " (did you mean 'fit'?)" for a text that differs by at most two letters from one of the names.
std::string suggestion(const std::string& text, const std::vector<std::string>& names) {
  const auto nearest = std::min_element(names.begin(), names.end(), [&text](const auto& a, const auto& b) {
    return distance(text, a) < distance(text, b);
  });
  constexpr std::size_t kClose = 2;
  return nearest == names.end() || distance(text, *nearest) > kClose ? "" : " (did you mean '" + *nearest + "'?)";
}

std::vector<std::string> option_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* const command : program.get_subcommands()) {
    for (const CLI::Option* const option : command->get_options()) names.push_back(option->get_name());
  }
  return names;
}

/// CLI11's errors as one line; --help and --version arrive here too and are no errors.
Outcome parse_outcome(const CLI::App& program, const CLI::ParseError& error) {
  if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::Success)) {
    const std::string message = error.what();
    const std::string last = message.substr(message.rfind(' ') + 1);
    const std::string meant = last.starts_with("--") ? suggestion(last, option_names(program)) : std::string();
    return {ExitCode::WrongUsage, message + meant + " (see " + command_line(program) + " --help)", "wrong_usage"};
  }
  (void)program.exit(error, std::cout, std::cerr);
  if (std::cout.flush()) return {};
  return {ExitCode::WrongUsage, std::string("cannot write to standard output: ") + std::strerror(errno),
          "cannot_write"};
}

void check_command(const CLI::App& program, const std::string& first_argument) {
  std::string known;
  std::vector<std::string> names;
  for (const CLI::App* const command : program.get_subcommands({})) {
    if (command->get_name() == first_argument) return;
    names.push_back(command->get_name());
    known += (known.empty() ? "" : ", ") + names.back();
  }
  if (first_argument.empty()) refuse("a command is missing: one of {}", known);
  if (first_argument.front() == '-') return;
  refuse("unknown command '{}'{}, expected a file or one of {}", first_argument, suggestion(first_argument, names),
         known);
}

bool is_unit(const std::string& text) {
  using enum slipfit::Dimension;
  constexpr std::array kDimensions{Time, Length,       Speed,     Force,    Frequency,
                                   Mass, AngularSpeed, Stiffness, Slowness, ForceRate};
  return std::any_of(kDimensions.begin(), kDimensions.end(),
                     [&text](slipfit::Dimension dimension) { return bool(slipfit::parse_unit(text, dimension)); });
}

/// "--speed 10 mm/s" without quotes arrives as three words: a number after an option, and a unit, which no file is
/// called, are one.
std::vector<std::string> with_quantities_joined(const std::vector<std::string>& words) {
  std::vector<std::string> joined;
  for (const std::string& word : words) {
    const bool is_after_number = joined.size() >= 2 && joined[joined.size() - 2].starts_with("--") &&
                                 joined[joined.size() - 2].find('=') == std::string::npos &&
                                 slipfit::parse_quantity(joined.back(), slipfit::Dimension::Dimensionless) &&
                                 slipfit::unit_in(joined.back()).empty();
    std::error_code error;
    if (is_after_number && is_unit(word) && !std::filesystem::exists(word, error)) {
      joined.back() += " " + word;
    } else {
      joined.push_back(word);
    }
  }
  return joined;
}

/// Refuses "--json out.json": the flag would leave out.json as one more file to read, which is not found.
void check_json_flag(const std::vector<std::string>& words) {
  const auto flag =
      std::adjacent_find(words.begin(), words.end(), [](const std::string& word, const std::string& next) {
        std::error_code error;
        return word == "--json" && next.ends_with(".json") && !std::filesystem::exists(next, error);
      });
  if (flag == words.end()) return;
  refuse("{0}: no such file; --json takes none: to write the document to {0}, give --json --out {0}", *std::next(flag));
}

struct Command {
  std::string_view name;
  void (*add)(CLI::App& program, const std::string& typed_line);
  std::string_view examples;  ///< One command line each.
};

/// All commands in the order of the help.
constexpr std::array kCommands = std::to_array<Command>({
    {"analyze", add_analyze_command,
     "  slipfit analyze run7.csv\n"
     "  slipfit analyze run7.csv --window 12:60 --json\n"},
    {"fit", add_fit_command,
     "  slipfit fit run7.csv --speed 10mm/s\n"
     "  slipfit fit run7.csv --speed 10mm/s --normal-force 5N --zero 0.02 --report run7.html\n"
     "  slipfit fit --joint sweep.csv --group dry --json --out dry.json\n"},
    {"info", add_info_command, "  slipfit info run7.csv\n"},
    {"simulate", add_simulate_command,
     "  slipfit simulate --stiffness 5000 --natural-frequency 900 --damping-ratio 0.05 --static-friction 4\n"
     "      --kinetic-friction 3 --speed 10mm/s --duration 2 --sample-rate 5kHz --noise 0.015 --out run.csv\n"},
    {"predict", add_predict_command,
     "  slipfit predict fit.json --speeds 1mm/s:1m/s:20\n"
     "  slipfit predict fit.json --speeds 5mm/s,10mm/s --csv prediction.csv\n"},
    {"plan", add_plan_command, "  slipfit plan fit.json --for damping_ratio\n"},
    {"figures", add_figures_command, "  slipfit figures --out figures\n"},
    {"compare", add_compare_command,
     "  slipfit compare dry.csv wet.csv --speed 10mm/s\n"
     "  slipfit compare runs.csv --group dry --group wet --report comparison.html\n"},
#ifndef SLIPFIT_SINGLE_PROCESS
    {"batch", add_batch_command,
     "  slipfit batch runs.csv --out results\n"
     "  slipfit batch *.csv --out results --speed 10mm/s --report results/index.html\n"
     "  slipfit batch runs.csv --out results --resume\n"},
    {"merge", add_merge_command, "  slipfit merge shard1 shard2 --out results\n"},
#endif
    {"manifest", add_manifest_command, "  slipfit manifest recordings --out runs.csv\n"},
    {"surface", add_surface_command,
     "  slipfit surface profile.csv\n"
     "  slipfit surface track.png --pixel 2.1um --along x\n"},
});

/// The heading under which the help lists an option; empty for options that only one command has.
std::string group_of(const std::string& name) {
  for (const slipfit::RecordingOption& option : slipfit::recording_options()) {
    if (option.name() != name) continue;
    return option.of == slipfit::RecordingOption::Of::Conditions ? "Recording and instrument" : "Contents of the file";
  }
  constexpr auto kOutput = std::to_array<std::string_view>(
      {"--json", "--out", "--quiet", "--details", "--cycles", "--report", "--plots", "--timing", "--curve", "--csv"});
  constexpr auto kSurface = std::to_array<std::string_view>(
      {"--surface", "--unit", "--pitch", "--pixel", "--along", "--x-column", "--z-column"});
  if (std::find(kOutput.begin(), kOutput.end(), name) != kOutput.end()) return "Output";
  return std::find(kSurface.begin(), kSurface.end(), name) != kSurface.end() ? "Worn surface" : "";
}

/// Groups the options of a command in its help and adds the examples.
void arrange_help(CLI::App& program, const Command& command) {
  CLI::App* const added = program.get_subcommand(std::string(command.name));
  for (CLI::Option* const option : added->get_options()) {
    const std::string group = group_of(option->get_name());
    if (!group.empty()) option->group(group);
  }
  added->footer("Examples:\n" + std::string(command.examples) + "\n" + program.get_footer());
}

bool is_command(std::string_view word) {
  return std::any_of(kCommands.begin(), kCommands.end(), [&](const Command& command) { return command.name == word; });
}

/// Only the command that is called, where one is: all options of all of them would be a fifth of the start-up.
void add_commands(CLI::App& program, const std::string& first_argument, const std::string& typed_line) {
  const auto is_called = [&](const Command& command) { return command.name == first_argument; };
  const bool is_one = is_command(first_argument);
  if (first_argument == "--version") return;
  for (const Command& command : kCommands) {
    if (is_one && !is_called(command)) continue;
    command.add(program, typed_line);
    arrange_help(program, command);
  }
}

void run(CLI::App& program, std::vector<std::string> words, const std::string& typed_line) {
  program.set_version_flag("--version", std::string("slipfit ") + SLIPFIT_VERSION);
  program.require_subcommand(1);
  program.footer(
      "Exit codes: 0 success, 1 some recordings of a batch failed, 2 wrong usage, 3 recording unreadable or without "
      "usable data.");
  std::error_code ignored;
  const bool is_file = words.size() > 1 && !words[1].starts_with('-') && std::filesystem::exists(words[1], ignored);
  if (is_file && !is_command(words[1])) words.insert(words.begin() + 1, "fit");  // slipfit REC
  add_commands(program, words.size() > 1 ? words[1] : "", typed_line);
  check_command(program, words.size() > 1 ? words[1] : "");
  check_json_flag(words);
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
    return {ExitCode::BadRecording, "not enough memory for this recording: use --window to read a part of it",
            "out_of_memory"};
  } catch (const std::exception& error) {
    return {ExitCode::BadRecording, std::string("internal error, please report it with the recording: ") + error.what(),
            "internal_error"};
  } catch (...) {
    return {ExitCode::BadRecording, "internal error, please report it with the recording", "internal_error"};
  }
}
