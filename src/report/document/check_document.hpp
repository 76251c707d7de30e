#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "report/document/json_node.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit::documents {

/// Checks the properties that every reader of a fit document relies on: its schema; known statuses; values of
/// parameters in their ranges; standard errors that are not negative; intervals with low <= value <= high; numbers of a
/// size that can be squared and multiplied. Throws ThrownError with the code bad_document.
void check_document(const JsonNode& document);

/// Returns `read(document)` of a checked document, or the error.
template <class Value, class Read>
Result<Value> with_document(const std::string& content, const std::string& name, const Read& read) {
  try {
    const nlohmann::json json = parse_document(content, name);
    const JsonNode document(name, json);
    check_document(document);
    return read(document);
  } catch (const ThrownError& refused) {
    return refused.error();
  }
}

}  // namespace slipfit::documents
