#pragma once

#include <string>

#include "slipfit/surface/surface.hpp"

namespace slipfit {

/// Writes one document of the schema slipfit.surface/1 (docs/surface.schema.json), without a trailing newline.
std::string to_json(const Profile& profile, const Surface& surface);

/// Writes the surface as text for people.
std::string to_text(const Profile& profile, const Surface& surface);

/// Writes one page with the profile and its ridges. Text from outside is escaped.
std::string to_html(const Profile& profile, const Surface& surface, const std::string& command_line);

}  // namespace slipfit
