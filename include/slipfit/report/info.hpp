#pragma once

#include <string>

#include "slipfit/inspection.hpp"

namespace slipfit {

/// Writes one document of the schema slipfit.info/1 (docs/info.schema.json), without a trailing newline. `file` is
/// written as given.
std::string to_json(const Inspection& inspection, const std::string& file);

/// Writes the contents of a file as text for people.
std::string to_text(const Inspection& inspection, const std::string& file);

}  // namespace slipfit
