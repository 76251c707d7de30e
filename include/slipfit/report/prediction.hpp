#pragma once

#include <string>
#include <vector>

#include "slipfit/predict/prediction.hpp"

namespace slipfit {

/// The origin of a prediction, for its reader.
struct PredictionSource {
  std::string name;                         ///< the fit document's file, or "command line"
  std::vector<std::string> conditional_on;  ///< what the model takes for granted
  std::string speed_unit = {};              ///< that the speeds were given in; empty: m/s
  Warnings warnings = {};                   ///< of the fit
};

/// Writes one document of the schema slipfit.predict/1 (docs/predict.schema.json), without a trailing newline, in valid
/// UTF-8; unknown values are null.
std::string to_json(const Prediction& prediction, const PredictionSource& source);

/// Writes a text for people: the critical speed, then one line for each speed with 95 % bands.
std::string to_text(const Prediction& prediction, const PredictionSource& source);

/// Writes one row for each speed: value, low and high of each quantity (docs/formats.md). Unknown cells are empty.
std::string prediction_to_csv(const Prediction& prediction);

}  // namespace slipfit
