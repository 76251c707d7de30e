#pragma once

#include <cstddef>

// What a parameter needs before it is called identified.

namespace slipfit::fit {

constexpr std::size_t kFewCycles = 5;          // below it a scatter says little
constexpr double kSamplesForIdentified = 3.0;  // in a slip

}  // namespace slipfit::fit
