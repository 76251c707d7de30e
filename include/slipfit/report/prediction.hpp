#pragma once

#include <string>
#include <vector>

#include "slipfit/predict/prediction.hpp"

namespace slipfit {

/// Where a prediction comes from, for its reader.
struct PredictionSource {
  std::string name;                         ///< the fit document's file, or "command line"
  std::vector<std::string> conditional_on;  ///< what the model takes for granted
  std::string speed_unit = {};              ///< that the speeds were given in; empty: m/s
  Warnings warnings = {};                   ///< of the fit
};

/// One document of the schema slipfit.predict/1 (docs/predict.schema.json), without a trailing newline: valid UTF-8,
/// what is not known is null.
std::string to_json(const Prediction& prediction, const PredictionSource& source);

/// For people: the critical speed, then one line a speed with 95 % bands.
std::string to_text(const Prediction& prediction, const PredictionSource& source);

/// One row a speed: value, low and high of each quantity (docs/formats.md). Unknown cells are empty.
std::string prediction_to_csv(const Prediction& prediction);

}  // namespace slipfit
