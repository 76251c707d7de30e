#pragma once

#include <optional>
#include <vector>

#include "report/document/json_node.hpp"
#include "slipfit/predict/plan.hpp"

namespace slipfit::documents {

/// How the recordings with cycles were made, their noise and scatter (medians).
struct RecordedConditions {
  std::vector<RecordingPlan> recordings;
  double noise_rms_N = 0.0;
  std::optional<double> force_drop_sd_N;
  LevelSharing levels = LevelSharing::Separate;
};

/// Throws BadDocument, also where the document has no residual in newtons.
RecordedConditions recorded_conditions(const JsonNode& document);

}  // namespace slipfit::documents
