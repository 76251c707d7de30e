#pragma once

#include <optional>
#include <string>

namespace slipfit {

/// SHA-256 of a file's bytes, 64 hexadecimal digits. Empty where it is no regular file or cannot be read.
std::optional<std::string> sha256_of_file(const std::string& file);

}  // namespace slipfit
