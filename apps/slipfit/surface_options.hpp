#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "slipfit/surface/surface.hpp"

/// A file of a worn surface, and what the user says about it.
struct SurfaceArguments {
  std::string file;
  slipfit::ProfileOptions options;
};

void add_profile_options(CLI::App& command, SurfaceArguments& arguments);

struct MeasuredSurface {
  slipfit::Profile profile;
  slipfit::Surface surface;
};

/// Reads and measures it. Throws Failure.
MeasuredSurface measure(const SurfaceArguments& arguments);
