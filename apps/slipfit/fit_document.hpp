#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slipfit/predict/plan.hpp"
#include "slipfit/predict/prediction.hpp"

/// What a prediction needs of a document that `slipfit fit --json` wrote.
struct FitDocument {
  slipfit::PredictionModel model;
  std::vector<std::string> conditional_on;
  slipfit::Warnings warnings;
};

/// What a plan needs of it beside: how the recordings with cycles were made, their noise and scatter (medians).
struct RecordedConditions {
  std::vector<slipfit::RecordingPlan> recordings;
  double noise_rms_N = 0.0;
  std::optional<double> force_drop_sd_N;
  slipfit::LevelSharing levels = slipfit::LevelSharing::Separate;
};

/// Throws Failure(WrongUsage) as read_fit_document(), and where the document has no residual in newtons.
RecordedConditions read_recorded_conditions(const std::string& file);

/// Throws Failure(WrongUsage) where the file cannot be read, is no fit document, or leaves a parameter open that the
/// motion depends on.
FitDocument read_fit_document(const std::string& file);
