#pragma once

#include <optional>
#include <string>
#include <utility>

#include "slipfit/core/estimate.hpp"

namespace slipfit {

/// Why what depends on the driving speed is not known.
inline constexpr const char* kNoSpeed = "no driving speed is stated: give it with --speed";

/// A number that is not known, and why.
inline Estimate unknown(std::string why) {
  return {std::nullopt, std::nullopt, std::nullopt, std::move(why)};
}

/// Appends a text to those that a note has already.
inline void add_note(std::string& note, const std::string& text) {
  note += (note.empty() ? "" : "; ") + text;
}

}  // namespace slipfit
