#pragma once

#include <string>

#include "slipfit/core/result.hpp"

namespace slipfit {

/// What to do about an error: what its message asks for, else what docs/formats.md says of its code; else empty.
std::string remedy_of(const Error& error);

}  // namespace slipfit
