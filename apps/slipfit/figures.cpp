#include "slipfit/figures/figures.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "output.hpp"
#include "quantities.hpp"

namespace fs = std::filesystem;

namespace {

struct FiguresArguments {
  std::optional<std::string> folder;
  DocumentOptions messages;
};

void add_options(CLI::App& command, FiguresArguments& arguments) {
  command.add_option("--out", arguments.folder, "Write into this folder; created if it does not exist");
  add_quiet_option(command, arguments.messages);
}

void run(const FiguresArguments& arguments) {
  const std::string folder = required(arguments.folder, "--out", "the folder for the figures");
  make_folder({"--out", folder});
  const std::vector<slipfit::FigureFile> files = slipfit::paper_figures();
  for (const slipfit::FigureFile& file : files)
    write_file({"--out", (fs::path(folder) / file.name).string()}, file.content);
  arguments.messages.notify(fmt::format("wrote {} files to '{}'", files.size(), folder));
}

}  // namespace

void add_figures_command(CLI::App& program, const std::string& /*typed_line*/) {
  add_command<FiguresArguments>(
      program, "figures", "Writes figures 2 to 8 of the paper and the stability map (CSV and SVG)", add_options, run);
}
