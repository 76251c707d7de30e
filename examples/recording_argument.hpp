#pragma once

#include <cstdio>
#include <cstdlib>
#include <slipfit/slipfit.hpp>
#include <utility>

/// The recording that the arguments RECORDING.csv and SPEED name; says what is wrong with them and ends the program.
inline slipfit::Recording recording_of(int argc, char** argv) {
  const auto end = [](int code, const char* message) {
    std::fprintf(stderr, "%s\n", message);
    std::exit(code);
  };
  if (argc != 3) end(2, "usage: PROGRAM RECORDING.csv SPEED");
  const auto speed_m_per_s = slipfit::parse_quantity(argv[2], slipfit::Dimension::Speed);
  if (!speed_m_per_s) end(2, speed_m_per_s.error().message.c_str());
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = speed_m_per_s.value();
  auto recording = slipfit::read_recording(argv[1], conditions);
  if (!recording) end(3, recording.error().message.c_str());
  return std::move(recording).value();
}
