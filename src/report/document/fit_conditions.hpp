#pragma once

#include "report/document/json_node.hpp"
#include "slipfit/predict/plan.hpp"

namespace slipfit::documents {

/// The model, how the recordings with cycles were made, their noise and scatter (medians). Throws BadDocument, also
/// where the document has no residual in newtons.
PlanBasis plan_basis_of(const JsonNode& document, ModelEstimate estimate);

}  // namespace slipfit::documents
