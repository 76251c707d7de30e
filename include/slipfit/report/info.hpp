#pragma once

#include <string>

#include "slipfit/inspection.hpp"

namespace slipfit {

/// One document of the schema slipfit.info/1 (docs/info.schema.json), without a trailing newline. `file`: as given.
std::string to_json(const Inspection& inspection, const std::string& file);

/// The same for people.
std::string to_text(const Inspection& inspection, const std::string& file);

}  // namespace slipfit
