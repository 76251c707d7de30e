#include <string>

#include "commands.hpp"
#include "failure.hpp"
#include "output.hpp"
#include "recording_options.hpp"
#include "slipfit/report/info.hpp"

namespace {

struct InfoArguments {
  RecordingArguments recording;
  DocumentOptions document;
};

void add_options(CLI::App& command, InfoArguments& arguments) {
  command.add_option("FILE", arguments.recording.files, "Files; several are described one after another")->required();
  add_options_where(command, arguments.recording, [](const slipfit::RecordingOption& option) {
    return option.of == slipfit::RecordingOption::Of::Reading;
  });
  add_document_options(command, arguments.document, "text");
}

void run(const InfoArguments& arguments) {
  const std::vector<std::string>& files = arguments.recording.files;
  for (const std::string& file : files) check_outputs(arguments.document.outputs, file);
  const slipfit::ReadOptions options = read_options_from(arguments.recording);
  const auto document_of = [&](std::size_t i) -> slipfit::Result<std::string> {
    const auto inspection = slipfit::inspect(files[i], options);
    if (!inspection) return inspection.error();
    return arguments.document.json ? to_json(inspection.value(), files[i]) + "\n"
                                   : to_text(inspection.value(), files[i]);
  };
  write_each(arguments.document, files.size(), document_of, [](const std::string&) { return ExitCode::BadRecording; });
}

}  // namespace

void add_info_command(CLI::App& program, const std::string& /*typed_line*/) {
  add_command<InfoArguments>(
      program, "info", "Lists the columns, units, clock and steps of a file and what would be read", add_options, run);
}
