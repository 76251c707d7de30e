#pragma once

#include <numbers>

namespace slipfit::signal {

constexpr double kTurn = 2.0 * std::numbers::pi;

}  // namespace slipfit::signal
