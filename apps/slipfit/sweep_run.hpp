#pragma once

#include <optional>
#include <string>
#include <vector>

#include "output.hpp"
#include "slipfit/fit/fit.hpp"

/// `fit --joint`: one parameter set for the recordings of a manifest's group.
struct SweepArguments {
  std::string manifest;
  std::optional<std::string> group;
  std::vector<std::string> only;  ///< ids; empty: all of the group
  DocumentOptions document;
  std::optional<std::string> report;
  std::string command_line;  ///< as typed, for the report
};

/// Reads the recordings, fits them together, writes the result. Throws Failure.
void run_sweep(const SweepArguments& arguments, const slipfit::FitOptions& options);
