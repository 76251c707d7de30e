#pragma once

#include <string>

#include "slipfit/core/result.hpp"

namespace slipfit {

/// Returns what to do about an error: the request in its message, otherwise the remedy of its code in docs/formats.md;
/// otherwise it is empty.
std::string remedy_of(const Error& error);

}  // namespace slipfit
