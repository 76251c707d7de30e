#include <memory>
#include <string>
#include <vector>

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
  const std::vector<OutputFile> outputs = outputs_of({{"--out", arguments.document.out}});
  check_outputs(outputs, file);
  const auto inspection = slipfit::inspect(file, read_options_from(arguments.recording));
  if (!inspection) throw Failure(ExitCode::BadRecording, inspection.error());
  write_results(arguments.document, outputs, [&](const std::string&) {
    return arguments.document.json ? to_json(inspection.value(), file) + "\n" : to_text(inspection.value(), file);
  });
}

}  // namespace

void add_info_command(CLI::App& program) {
  CLI::App* const command =
      program.add_subcommand("info", "What a file holds: columns, units, clock, steps; and what would be read of it");
  const auto arguments = std::make_shared<InfoArguments>();
  command->add_option("FILE", arguments->recording.files, "Recording")->required();
  command->add_option("--radius", arguments->recording.radius, "Distance of the contact from the axis: 12mm");
  add_reading_options(*command, arguments->recording.options);
  add_document_options(*command, arguments->document, "text");
  command->callback([arguments] { run(*arguments); });
}
