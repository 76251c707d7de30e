#include <memory>
#include <numbers>

#include "commands.hpp"
#include "failure.hpp"
#include "output.hpp"
#include "quantities.hpp"
#include "slipfit/report/surface.hpp"
#include "surface_options.hpp"

namespace {

struct SurfaceCommand {
  SurfaceArguments surface;
  DocumentOptions document;
  std::optional<std::string> report;
  std::string command_line;
};

void run_surface(const SurfaceCommand& arguments) {
  const std::vector<OutputFile> outputs =
      outputs_of({{"--out", arguments.document.out}, {"--report", arguments.report}});
  check_outputs(outputs, arguments.surface.file);
  const MeasuredSurface measured = measure(arguments.surface);
  write_results(arguments.document, outputs, [&](const std::string& option) {
    if (option == "--report") return slipfit::to_html(measured.profile, measured.surface, arguments.command_line);
    return arguments.document.json ? slipfit::to_json(measured.profile, measured.surface) + "\n"
                                   : slipfit::to_text(measured.profile, measured.surface);
  });
}

/// "x", "y", or degrees from the x axis.
double direction(const std::string& text) {
  if (text == "x") return 0.0;
  const double degrees = text == "y" ? 90.0 : plain_number("--along", text, "degrees from the x axis (or x, y)");
  return degrees * std::numbers::pi / 180.0;
}

}  // namespace

MeasuredSurface measure(const SurfaceArguments& arguments) {
  slipfit::ProfileOptions options;
  options.x_column = arguments.x_column;
  options.z_column = arguments.z_column;
  const auto length = [](const char* option, const std::optional<std::string>& text) {
    return text ? std::optional(positive_quantity(option, *text, slipfit::Dimension::Length)) : std::nullopt;
  };
  options.pitch_m = length("--pitch", arguments.pitch);
  options.pixel_m = length("--pixel", arguments.pixel);
  if (arguments.unit) {
    const auto unit = slipfit::parse_unit(*arguments.unit, slipfit::Dimension::Length);
    if (!unit) throw Failure(ExitCode::WrongUsage, "--unit: " + unit.error().message);
    options.unit_m = unit.value().scale;
  }
  if (arguments.along) options.along_rad = direction(*arguments.along);
  auto profile = slipfit::read_profile(arguments.file, options);
  if (!profile) throw Failure(ExitCode::BadRecording, profile.error());
  auto surface = slipfit::measure_surface(profile.value());
  if (!surface) throw Failure(ExitCode::BadRecording, surface.error());
  return {std::move(profile).value(), std::move(surface).value()};
}

void add_profile_options(CLI::App& command, SurfaceArguments& arguments) {
  command.add_option("--unit", arguments.unit, "Of lengths and heights of a text that names none: um");
  command.add_option("--pitch", arguments.pitch, "Distance of the points of a text of heights alone: 1um");
  command.add_option("--pixel", arguments.pixel, "Size of an image's pixel on the surface: 2.1um");
  command.add_option("--along", arguments.along, "Direction of sliding on an area: x, y, or degrees from x");
  command.add_option("--x-column", arguments.x_column, "Places along the track: name or 1-based number");
  command.add_option("--z-column", arguments.z_column, "Heights: name or 1-based number");
}

void add_surface_command(CLI::App& program, const std::string& command_line) {
  CLI::App* const command = program.add_subcommand("surface", "Spacing of the pattern on a worn surface");
  const auto arguments = std::make_shared<SurfaceCommand>();
  arguments->command_line = command_line;
  command->add_option("FILE", arguments->surface.file, "Profile (text, X3P, SDF) or image (PNG, TIFF, JPEG)")
      ->required();
  add_profile_options(*command, arguments->surface);
  add_document_options(*command, arguments->document, "text");
  command->add_option("--report", arguments->report, "Write a page to look at and to print (HTML, one file)");
  command->callback([arguments] { run_surface(*arguments); });
}
