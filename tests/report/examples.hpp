#pragma once

#include <string>

#include "slipfit/pipeline.hpp"

namespace test {

/// Twenty samples at 1 kHz, 10 mm/s.
slipfit::Recording small_recording(slipfit::ForceQuantity quantity = slipfit::ForceQuantity::Force_N,
                                   const std::string& file = "folder/run.csv");

/// A stick-slip result with every kind of parameter status and numbers of its own for every key.
slipfit::Analysis full_analysis();

}  // namespace test
