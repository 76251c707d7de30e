#pragma once

#include <string>
#include <vector>

#include "slipfit/predict/prediction.hpp"

/// What a prediction needs of a document that `slipfit fit --json` wrote.
struct FitDocument {
  slipfit::PredictionModel model;
  std::vector<std::string> conditional_on;
};

/// Throws Failure(WrongUsage) where the file cannot be read, is no fit document, or leaves a parameter open that the
/// motion depends on.
FitDocument read_fit_document(const std::string& file);
