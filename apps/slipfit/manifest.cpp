#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "drafts.hpp"
#include "output.hpp"
#include "slipfit/core/printable.hpp"

namespace {

struct ManifestArguments {
  std::vector<std::filesystem::path> paths;
  std::optional<std::string> out;
  bool quiet = false;
};

/// Prints what the user has to fill in or should check.
void notify_of(const slipfit::ManifestDraft& draft) {
  for (const slipfit::Error& error : draft.skipped) say("left out: " + error.message);
  const auto without_speed =
      std::count_if(draft.entries.begin(), draft.entries.end(), [](const auto& entry) { return !entry.speed_m_per_s; });
  if (without_speed > 0)
    say(fmt::format("{} of {} recordings have no speed: fill it in", without_speed, draft.entries.size()));
}

void run(const ManifestArguments& arguments) {
  const OutputFile output{"--out", arguments.out.value_or("")};
  if (arguments.out) check_outputs({output}, "");
  const slipfit::ManifestDraft draft = slipfit::writable(slipfit::draft_manifest(arguments.paths));
  check_found(draft);
  if (!arguments.quiet) notify_of(draft);
  const std::filesystem::path folder = std::filesystem::path(arguments.out.value_or("")).parent_path();
  const std::string text = slipfit::to_csv(draft, folder);
  // A terminal gets no format characters of names; a file or a program gets the names as they are.
  if (!arguments.out)
    return write_standard_output(::isatty(STDOUT_FILENO) == 1 ? slipfit::printable_lines(text) : text);
  write_file(output, text);
  if (!arguments.quiet) say(fmt::format("wrote {} recordings to '{}'", draft.entries.size(), *arguments.out));
}

}  // namespace

void add_manifest_command(CLI::App& program) {
  CLI::App* const command =
      program.add_subcommand("manifest", "Drafts a manifest: recordings, speeds and loads from columns and file names");
  const auto arguments = std::make_shared<ManifestArguments>();
  command->add_option("PATH", arguments->paths, "Folders and files")->required();
  command->add_option("--out", arguments->out, "Write it to this file");
  command->add_flag("--quiet", arguments->quiet, "Print only errors on standard error");
  command->callback([arguments] { run(*arguments); });
}
