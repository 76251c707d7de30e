#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "output.hpp"
#include "recording_options.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/sweep.hpp"
#include "surface_options.hpp"

/// The options that `analyze` and `fit` share: results to write, and their files.
struct AnalysisArguments {
  RecordingArguments recording;
  DocumentOptions document;
  bool timing = false;
  std::optional<std::string> plots;  ///< folder for SVG files
  SurfaceArguments surface;          ///< the worn track; an empty file name: none
};

void add_analysis_options(CLI::App& command, AnalysisArguments& arguments);

/// Reads the recording, analyses it, writes every result that was asked for. Throws Failure.
void run_analysis(const AnalysisArguments& arguments,
                  const std::function<slipfit::Analysis(const slipfit::Recording&)>& analysis);

/// Analyses several recordings separately, with text or JSON as the only output. Throws Failure.
void run_each(const AnalysisArguments& arguments,
              const std::function<slipfit::Analysis(const slipfit::Recording&)>& analysis);

/// Returns true if the strokes or segments of the recording are requested.
bool is_of_pieces(const AnalysisArguments& arguments);

/// Analyses several recordings in one file. Throws Failure.
void run_pieces(const AnalysisArguments& arguments,
                const std::function<slipfit::SweepAnalysis(const std::vector<slipfit::SweepEntry>&)>& analysis);
