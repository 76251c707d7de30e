#pragma once

#include <span>
#include <vector>

#include "io/layout.hpp"
#include "io/opened_file.hpp"
#include "io/part.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/io/named_recording.hpp"

namespace slipfit::reading {

/// The force is measured with the other sign: at least 90 % of the samples are negative.
bool is_negative_throughout(std::span<const double> force);

/// Forces that oppose the motion, and what the columns say of speed and load. Errors: those of describe_part
/// and Recording::create; no_speed, speed_varies, speed_contradicted, no_strokes. The strokes of a reciprocating test
/// are one recording.
Recording build_recording(Part part, const OpenedFile& file, const Conditions& conditions);

/// The strokes of a reciprocating test, of those of `file.options.pieces` at most `kMostPieces`, spread evenly. Errors:
/// those above; no_strokes.
std::vector<NamedRecording> build_strokes(Part part, const OpenedFile& file, const Conditions& conditions);

/// A joint fit of more takes minutes.
constexpr std::size_t kMostPieces = 16;

}  // namespace slipfit::reading
