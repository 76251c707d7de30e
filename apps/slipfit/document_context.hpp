#pragma once

#include <optional>
#include <string>
#include <vector>

#include "json_node.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/predict/observed_end.hpp"

// What a fit document says around its parameters. Documents of earlier versions lack parts of it.

/// A number >= 0, or null.
std::optional<double> checked_error(const JsonNode& node);

/// Of a sweep.
std::optional<slipfit::SpeedReach> reach(const JsonNode& document);
std::optional<double> normal_force_N(const JsonNode& document);
slipfit::ObservedEnd observed_end(const JsonNode& document);

slipfit::Warnings warnings(const JsonNode& document);
/// What the fit takes for granted.
std::vector<std::string> conditions(const JsonNode& document);
