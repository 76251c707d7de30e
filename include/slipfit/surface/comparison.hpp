#pragma once

#include <filesystem>
#include <string>

#include "slipfit/core/recording.hpp"
#include "slipfit/surface/surface.hpp"

namespace slipfit {

/// Whether a pattern on a surface is the one that a force trace tells of.
struct SpacingComparison {
  Estimate En;     ///< ISO 13528: surface less force over the root of the squared 95 % reaches; within +-1 they agree
  Estimate ratio;  ///< surface over force
  std::string verdict;  ///< one sentence
};
SpacingComparison compare_spacings(const Estimate& by_force_m, const Estimate& on_surface_m);

WornTrack worn_track_of(const Profile& profile, const Surface& surface);

/// The conditions with the track in this file measured; as they are where no file is named. Errors: those of
/// `read_profile` and `measure_surface`.
Result<Conditions> with_worn_track(Conditions conditions, const std::filesystem::path& file);

}  // namespace slipfit
