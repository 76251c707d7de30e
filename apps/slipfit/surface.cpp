#include <numbers>

#include "commands.hpp"
#include "failure.hpp"
#include "output.hpp"
#include "quantities.hpp"
#include "slipfit/core/units.hpp"
#include "slipfit/report/surface.hpp"
#include "surface_options.hpp"

namespace {

struct SurfaceCommand {
  SurfaceArguments surface;
  DocumentOptions document;
};

void run_surface(const SurfaceCommand& arguments) {
  check_outputs(arguments.document.outputs, arguments.surface.file);
  const MeasuredSurface measured = measure(arguments.surface);
  write_results(arguments.document, [&](const std::string& option) {
    if (option == "--report")
      return slipfit::to_html(measured.profile, measured.surface, arguments.document.command_line);
    return arguments.document.json ? slipfit::to_json(measured.profile, measured.surface) + "\n"
                                   : slipfit::to_text(measured.profile, measured.surface);
  });
}

/// "x", "y", or degrees from the x axis.
double direction(const std::string& text) {
  if (text == "x") return 0.0;
  if (text == "y") return std::numbers::pi / 2.0;
  const auto degrees = slipfit::parse_quantity(text, slipfit::Dimension::Dimensionless);
  if (!degrees || !slipfit::unit_in(text).empty()) {
    refuse("--along: bad direction '{}', expected x, y or a number of degrees from the x axis", text);
  }
  return degrees.value() * std::numbers::pi / 180.0;
}

double length_unit_m(const std::string& text) {
  const auto unit = slipfit::parse_unit(text, slipfit::Dimension::Length);
  if (!unit) refuse("--unit: {}", unit.error().message);
  return unit.value();
}

void add_options(CLI::App& command, SurfaceCommand& arguments) {
  command.add_option("FILE", arguments.surface.file, "Profile (text, X3P, SDF) or image (PNG, TIFF, JPEG)")->required();
  add_profile_options(command, arguments.surface);
  add_document_options(command, arguments.document, "text");
  add_report_option(command, arguments.document);
}

}  // namespace

MeasuredSurface measure(const SurfaceArguments& arguments) {
  slipfit::Profile profile =
      value_or_fail(slipfit::read_profile(arguments.file, arguments.options), ExitCode::BadRecording);
  slipfit::Surface surface = value_or_fail(slipfit::measure_surface(profile), ExitCode::BadRecording);
  return {std::move(profile), std::move(surface)};
}

void add_profile_options(CLI::App& command, SurfaceArguments& arguments) {
  slipfit::ProfileOptions& options = arguments.options;
  command.add_option_function<std::string>(
      "--unit", [&options](const std::string& text) { options.unit_m = length_unit_m(text); },
      "Unit of lengths and heights in a text file without units: um");
  add_quantity(command, "--pitch", options.pitch_m, slipfit::Dimension::Length, Limits::AboveZero,
               "Distance between points in a text file that contains only heights: 1um");
  add_quantity(command, "--pixel", options.pixel_m, slipfit::Dimension::Length, Limits::AboveZero,
               "Size of a pixel of the image on the surface: 2.1um");
  command.add_option_function<std::string>(
      "--along", [&options](const std::string& text) { options.along_rad = direction(text); },
      "x|y|DEGREES: sliding direction on an area, degrees from x");
  command.add_option("--x-column", options.x_column, "Column of positions along the track: name or 1-based number");
  command.add_option("--z-column", options.z_column, "Column of heights: name or 1-based number");
}

void add_surface_command(CLI::App& program, const std::string& typed_line) {
  SurfaceCommand arguments;
  arguments.document.command_line = typed_line;
  add_command<SurfaceCommand>(program, "surface", "Measures the spacing of the pattern on a worn surface", add_options,
                              run_surface, arguments);
}
