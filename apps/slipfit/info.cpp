#include <memory>
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

void run(const InfoArguments& arguments) {
  const std::string& file = only_file(arguments.recording);
  check_outputs(arguments.document.outputs, file);
  const auto inspection = slipfit::inspect(file, read_options_from(arguments.recording));
  if (!inspection) throw Failure(ExitCode::BadRecording, inspection.error());
  write_results(arguments.document, [&](const std::string&) {
    return arguments.document.json ? to_json(inspection.value(), file) + "\n" : to_text(inspection.value(), file);
  });
}

}  // namespace

void add_info_command(CLI::App& program) {
  CLI::App* const command =
      program.add_subcommand("info", "What a file holds: columns, units, clock, steps; and what would be read of it");
  const auto arguments = std::make_shared<InfoArguments>();
  command->add_option("FILE", arguments->recording.files, "Recording")->required();
  add_options_where(*command, arguments->recording, [](const slipfit::RecordingOption& option) {
    return option.of == slipfit::RecordingOption::Of::Reading;
  });
  add_document_options(*command, arguments->document, "text");
  command->callback([arguments] { run(*arguments); });
}
