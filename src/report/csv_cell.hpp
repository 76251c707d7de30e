#pragma once

#include <optional>
#include <string>

namespace slipfit {

/// The shortest text that reads back as the same double; empty where there is no number.
std::string cell(std::optional<double> value);

}  // namespace slipfit
