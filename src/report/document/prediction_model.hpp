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

/// `name`: of the document in messages. Throws ThrownError.
FitDocument fit_document_from(const JsonNode& document, const std::string& name);

/// Without these there is no prediction: the first of ModelEstimate::covariance.
inline constexpr std::span kNeeded = std::span(kModelParameters).first<4>();

std::string key_of(ParameterId id);

/// Of the correlation's matrix; empty where it has none of that name.
std::optional<std::size_t> find_row(const JsonNode& names, const std::string& name);
/// Refuses a document that has none.
std::size_t row_of(const JsonNode& names, const std::string& name);

/// From standard errors and correlation; leaves `model` without covariance where the document has none.
void read_covariance(const JsonNode& document, PredictionModel& model);

}  // namespace slipfit::documents
