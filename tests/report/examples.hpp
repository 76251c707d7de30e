#pragma once

#include <string>

#include "slipfit/pipeline.hpp"

namespace test {

/// Twenty samples at 1 kHz, 10 mm/s.
slipfit::Recording small_recording(slipfit::ForceQuantity quantity = slipfit::ForceQuantity::Force_N,
                                   const std::string& file = "folder/run.csv");

/// Two seconds of a simulated slider with stick-slip at 2 kHz: k 1000 N/m, w_n 200 rad/s, zeta 0.05, F_s 3 N, F_k 2.5
/// N.
slipfit::Recording stick_slip_recording(double speed_m_per_s);

/// A stick-slip result with every kind of parameter status and numbers of its own for every key.
slipfit::Analysis full_analysis();

}  // namespace test
