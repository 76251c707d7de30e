#include "slipfit/report/surface.hpp"

#include <fmt/format.h>

#include <numbers>

#include "core/unknown.hpp"
#include "report/blocks.hpp"
#include "report/json_values.hpp"
#include "report/quantity_rows.hpp"
#include "report/text_sections.hpp"

namespace slipfit {

std::string name_of(SurfaceStatus status) {
  return std::string(kNames<SurfaceStatus>.at(static_cast<std::size_t>(status)));
}

std::string to_json(const Profile& profile, const Surface& surface) {
  Json json{{"schema", "slipfit.surface/1"}, {"version", SLIPFIT_VERSION}};
  json["profile"] = {
      {"file", profile.file},
      {"points", profile.height.size()},
      {"pitch_m", profile.pitch_m},
      {"rows", profile.rows},
      {"along_degrees", profile.along_rad ? Json(*profile.along_rad * 180.0 / std::numbers::pi) : Json()}};
  json["status"] = surface.status;
  for (const auto& quantity : kPattern) {
    const Estimate estimate = quantity.of(surface);
    json[std::string(quantity.key)] = quantity.is_number ? Json(estimate.value) : Json(estimate);
  }
  json["ridge_height_m"] = profile.height_in_metres ? surface.ridge_height : unknown("the heights have no unit");
  json["ridges"] = surface.ridges;
  json["method"] = surface.method;
  json["warnings"] = surface.warnings;
  json["assumed"] = profile.assumed;
  return text_of(json);
}

Block pattern_block(const Profile& profile, const Surface& surface) {
  Block block{"pattern", "Pattern"};
  block.rows.push_back({"status", name_of(surface.status)});
  if (surface.ridges > 0) block.rows.push_back({"ridges", std::to_string(surface.ridges)});
  block.add("ridge height", surface.ridge_height, profile.height_in_metres ? "m" : "");
  for (const auto& quantity : kPattern) {
    block.add(quantity.words, quantity.of(surface), std::string(quantity.unit));
  }
  return block;
}

std::string to_text(const Profile& profile, const Surface& surface) {
  return fmt::format("{}: {} points, pitch {}\n", profile.file, profile.height.size(),
                     quantity_text(profile.pitch_m, "m")) +
         text_of(pattern_block(profile, surface)) + warnings_text(surface.warnings) + assumed_text(profile.assumed);
}

}  // namespace slipfit
