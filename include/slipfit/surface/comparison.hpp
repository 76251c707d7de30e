#pragma once

#include <filesystem>
#include <string>

#include "slipfit/core/recording.hpp"
#include "slipfit/surface/surface.hpp"

namespace slipfit {

/// The comparison of a pattern on a surface with the spacing of a force trace.
struct SpacingComparison {
  Estimate En;     ///< ISO 13528: surface less force over the root of the squared 95 % reaches; within +-1 they agree
  Estimate ratio;  ///< surface over force
  std::string verdict;  ///< one sentence
};
SpacingComparison compare_spacings(const Estimate& by_force_m, const Estimate& on_surface_m);

WornTrack worn_track_of(const Profile& profile, const Surface& surface);

/// Returns the conditions with the measured track in this file; unchanged if no file is given. Errors: those of
/// `read_profile` and `measure_surface`.
Result<Conditions> with_worn_track(Conditions conditions, const std::filesystem::path& file);

}  // namespace slipfit
