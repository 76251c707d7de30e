#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "report/document/json_node.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/report/fit_document.hpp"

namespace slipfit::documents {

/// Reads the document; messages call it `name`. Throws ThrownError.
FitDocument fit_document_from(const JsonNode& document, const std::string& name);

/// Parameters without which there is no prediction: the first of ModelEstimate::covariance.
inline constexpr std::span kNeeded = std::span(kModelParameters).first<4>();

std::string key_of(ParameterId id);

/// Returns the row of the correlation matrix with this name, or nothing.
std::optional<std::size_t> find_row(const JsonNode& names, const std::string& name);
/// Refuses a document that has none.
std::size_t row_of(const JsonNode& names, const std::string& name);

/// Reads the covariance from standard errors and correlation; `model` has none if the document has none.
void read_covariance(const JsonNode& document, PredictionModel& model);

}  // namespace slipfit::documents
