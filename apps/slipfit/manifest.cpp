#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "commands.hpp"
#include "drafts.hpp"
#include "output.hpp"
#include "slipfit/core/printable.hpp"

namespace {

struct ManifestArguments {
  std::vector<std::filesystem::path> paths;
  DocumentOptions document;
};

void add_options(CLI::App& command, ManifestArguments& arguments) {
  command.add_option("PATH", arguments.paths, "Folders and files")->required();
  add_output_option(command, arguments.document, "--out", "Write it to this file");
  add_quiet_option(command, arguments.document);
}

void run(const ManifestArguments& arguments) {
  const DocumentOptions& document = arguments.document;
  check_outputs(document.outputs, "");
  const slipfit::ManifestDraft draft = slipfit::writable(slipfit::draft_manifest(arguments.paths));
  check_found(draft);
  for (const slipfit::DraftEntry& entry : draft.entries) check_outputs(document.outputs, entry.file.string());
  for (const slipfit::Error& error : draft.skipped) document.notify("left out: " + error.message);
  const auto without_speed =
      std::count_if(draft.entries.begin(), draft.entries.end(), [](const auto& entry) { return !entry.speed_m_per_s; });
  if (without_speed > 0) {
    document.notify(fmt::format("{} of {} recordings have no speed: fill it in", without_speed, draft.entries.size()));
  }
  const OutputFile output = document.outputs.empty() ? OutputFile{} : document.outputs.back();
  const std::string text = slipfit::to_csv(draft, std::filesystem::path(output.file).parent_path());
  // A terminal gets no format characters of names; a file or a program gets the names as they are.
  if (document.outputs.empty())
    return write_standard_output(::isatty(STDOUT_FILENO) == 1 ? slipfit::printable_lines(text) : text);
  write_file(output, text);
  document.notify(fmt::format("wrote {} recordings to '{}'", draft.entries.size(), output.file));
}

}  // namespace

void add_manifest_command(CLI::App& program, const std::string& /*typed_line*/) {
  add_command<ManifestArguments>(program, "manifest",
                                 "Drafts a manifest: recordings, speeds and loads from columns and file names",
                                 add_options, run);
}
