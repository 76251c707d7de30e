#include "recording_options.hpp"

#include <cctype>

#include "failure.hpp"

using slipfit::RecordingOption;

namespace {

const CLI::Validator kNotEmpty([](const std::string& text) { return text.empty() ? "a value is missing" : ""; }, "");

/// Splits what --speed is given as, such as 10mm/s,20mm/s, at commas after a unit: others are those of decimals.
std::vector<std::string> speeds_in(const std::vector<std::string>& said) {
  std::vector<std::string> speeds;
  for (const std::string& text : said) {
    std::size_t begin = 0;
    for (std::size_t i = 1; i < text.size(); ++i) {
      if (text[i] != ',' || std::isalpha(static_cast<unsigned char>(text[i - 1])) == 0) continue;
      speeds.push_back(text.substr(begin, i - begin));
      begin = i + 1;
    }
    speeds.push_back(text.substr(begin));
  }
  return speeds;
}

}  // namespace

void add_options_where(CLI::App& command, RecordingArguments& arguments,
                       const std::function<bool(const RecordingOption&)>& is_wanted) {
  for (const RecordingOption& option : slipfit::recording_options()) {
    if (!is_wanted(option)) continue;
    const std::string names(option.option);
    const std::string help(option.help);
    if (option.column == "speed") {
      const auto take = [&arguments](const std::vector<std::string>& said) { arguments.speeds = speeds_in(said); };
      command.add_option_function<std::vector<std::string>>(names, take, help)
          ->allow_extra_args(false)
          ->check(kNotEmpty);
      continue;
    }
    std::string& text = arguments.said[std::string(option.column)];
    names.ends_with('}') ? command.add_flag(names, text, help)
                         : command.add_option(names, text, help)->check(kNotEmpty);
  }
}

void add_recording_options(CLI::App& command, RecordingArguments& arguments) {
  command.add_option("REC", arguments.files, "Recording: text with a time and a force column")->required();
  add_options_where(command, arguments, [](const RecordingOption&) { return true; });
}

std::vector<RecordingOption> given_options(const RecordingArguments& arguments) {
  std::vector<RecordingOption> given = slipfit::recording_options();
  std::erase_if(given, [&arguments](const RecordingOption& option) {
    const auto said = arguments.said.find(std::string(option.column));
    return option.column == "speed" ? arguments.speeds.empty() : said == arguments.said.end() || said->second.empty();
  });
  return given;
}

const std::string& only_file(const RecordingArguments& arguments) {
  if (arguments.files.size() == 1) return arguments.files.front();
  refuse("'{}' is a second file, expected one", arguments.files.at(1));
}

slipfit::ManifestEntry entry_at(const RecordingArguments& arguments, const std::optional<std::string>& speed) {
  std::vector<slipfit::NamedCell> cells;
  for (const RecordingOption& option : given_options(arguments)) {
    const std::string column(option.column);
    if (column != "speed") cells.push_back({column, arguments.said.at(column), std::string(option.name())});
  }
  if (speed) cells.push_back({"speed", *speed, "--speed"});
  slipfit::ManifestEntry entry = value_or_fail(slipfit::entry_from_cells(std::move(cells)));
  entry.conditions.speed_is_known = !arguments.speed_is_optional;
  return entry;
}

slipfit::ManifestEntry entry_from(const RecordingArguments& arguments) {
  if (arguments.speeds.size() > 1)
    refuse(
        "--speed: one recording has one speed, give it once; steps of a file get their own in a manifest with the "
        "columns id,file,speed_m_per_s,step");
  return entry_at(arguments, arguments.speeds.empty() ? std::nullopt : std::optional(arguments.speeds.front()));
}

slipfit::ReadOptions read_options_from(const RecordingArguments& arguments) {
  RecordingArguments without_error = arguments;  // which may be a percentage of the speed
  without_error.said.erase("speed_se");
  return entry_at(without_error, std::nullopt).options;
}
