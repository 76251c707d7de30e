#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/document/json_node.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/predict/observed_end.hpp"

namespace slipfit::documents {

// What a fit document says around its parameters. Documents of earlier versions lack parts of it.

/// A number >= 0, or null.
std::optional<double> checked_error(const JsonNode& node);

/// Of a sweep.
std::optional<SpeedReach> reach(const JsonNode& document);
std::optional<double> normal_force_N(const JsonNode& document);
ObservedEnd observed_end(const JsonNode& document);

Warnings warnings(const JsonNode& document);
/// What the fit takes for granted.
std::vector<std::string> conditions(const JsonNode& document);

}  // namespace slipfit::documents
