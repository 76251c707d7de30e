#pragma once

#include <optional>
#include <string>
#include <vector>

#include "output.hpp"
#include "slipfit/fit/fit.hpp"
#include "slipfit/sweep.hpp"

/// `fit --joint`: one parameter set for the recordings of a manifest's group.
struct SweepArguments {
  std::string manifest;
  std::optional<std::string> group;
  std::vector<std::string> only;  ///< ids; empty: all of the group
  DocumentOptions document;
  std::optional<std::string> report;
  std::string command_line;  ///< as typed, for the report
};

/// What is written of several recordings, and how it is called.
struct SweepDocument {
  std::string name;
  DocumentOptions document;
  std::optional<std::string> report;
  std::string command_line;
};
void write_sweep(const SweepDocument& document, const std::vector<slipfit::SweepEntry>& entries,
                 const slipfit::SweepAnalysis& sweep);

/// Reads the recordings, fits them together, writes the result. Throws Failure.
void run_sweep(const SweepArguments& arguments, const slipfit::FitOptions& options);
