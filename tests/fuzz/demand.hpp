#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string>

#include "slipfit/core/result.hpp"

/// What libFuzzer calls, and replay.cpp: one definition a target.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace fuzz {

/// Ends the program, which is how a fuzzer learns of a fault.
inline void demand(bool holds, const std::string& what) {
  if (holds) return;
  std::cerr << "demanded, and not so: " << what << '\n';
  std::abort();
}

inline bool is_one_line(const std::string& text) {
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == '\x7F') return false;
  }
  return !text.empty();
}

/// A code for scripts, and one line for people.
inline void demand_readable(const slipfit::Error& error) {
  demand(!error.code.empty(), "an error has a code");
  demand(is_one_line(error.message), "the message is one line: " + error.message);
}

}  // namespace fuzz
