#pragma once

#include <optional>
#include <string>

#include "report/document/json_node.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/report/quantities.hpp"

namespace slipfit::documents {

/// A quantity as a document states it, in SI.
struct DocumentQuantity {
  Estimate estimate;   ///< of a bounded or unidentified parameter the interval alone
  std::string status;  ///< of a parameter: identified, conditional, ...; else empty
};

/// Returns a quantity from its section, or nothing if it is absent or null. Forces of a friction coefficient are in the
/// object "coefficient".
std::optional<DocumentQuantity> quantity_in(const JsonNode& document, const Quantity& quantity);

Warnings warnings_in(const JsonNode& document);

}  // namespace slipfit::documents
