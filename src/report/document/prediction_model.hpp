#pragma once

#include <string>

#include "report/document/json_node.hpp"
#include "slipfit/report/fit_document.hpp"

namespace slipfit::documents {

/// `name`: of the document in messages. Throws ThrownError.
FitDocument fit_document_from(const JsonNode& document, const std::string& name);

}  // namespace slipfit::documents
