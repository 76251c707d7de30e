#pragma once

#include <string>

#include "slipfit/surface/surface.hpp"

namespace slipfit {

/// One document of the schema slipfit.surface/1 (docs/surface.schema.json), without a trailing newline.
std::string to_json(const Profile& profile, const Surface& surface);

/// The same for people.
std::string to_text(const Profile& profile, const Surface& surface);

/// One page with the profile and its ridges. Text from outside stays text.
std::string to_html(const Profile& profile, const Surface& surface, const std::string& command_line);

/// "periodic", "irregular", "none", "undetermined".
std::string name_of(SurfaceStatus status);

}  // namespace slipfit
