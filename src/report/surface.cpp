#include "slipfit/report/surface.hpp"

#include <fmt/format.h>

#include <array>
#include <numbers>

#include "core/unknown.hpp"
#include "report/blocks.hpp"
#include "report/json_sections.hpp"
#include "report/text_sections.hpp"

namespace slipfit {

std::string name_of(SurfaceStatus status) {
  constexpr std::array<const char*, 4> kNames{"periodic", "irregular", "none", "undetermined"};
  return kNames.at(static_cast<std::size_t>(status));
}

std::string to_json(const Profile& profile, const Surface& surface) {
  Json json{{"schema", "slipfit.surface/1"}, {"version", SLIPFIT_VERSION}};
  json["profile"] = {
      {"file", profile.file},
      {"points", profile.height.size()},
      {"pitch_m", profile.pitch_m},
      {"rows", profile.rows},
      {"along_degrees", profile.along_rad ? Json(*profile.along_rad * 180.0 / std::numbers::pi) : Json()}};
  json["status"] = name_of(surface.status);
  json["spacing_m"] = surface.spacing_m;
  json["fine_spacing_m"] = surface.fine_spacing_m;
  json["ridge_height_m"] = profile.height_in_metres ? surface.ridge_height : unknown("the heights have no unit");
  json["ridges"] = surface.ridges;
  json["spacing_sd_m"] = surface.spacing_sd_m;
  json["spacing_begin_m"] = surface.begin_spacing_m;
  json["spacing_end_m"] = surface.end_spacing_m;
  json["asymmetry"] = surface.asymmetry;
  json["rsm_m"] = surface.rsm_m;
  json["cutoff_m"] = surface.cutoff_m;
  json["smoothed_over_m"] = surface.smoothed_over_m;
  json["method"] = surface.method ? Json(*surface.method == SurfaceMethod::Comb ? "comb" : "ridges") : Json();
  json["warnings"] = surface.warnings;
  json["assumed"] = profile.assumed;
  return text_of(json);
}

Block pattern_block(const Profile& profile, const Surface& surface) {
  Block block{"pattern", "Pattern"};
  const auto add_length = [&block](const char* label, const std::optional<double>& length_m) {
    if (length_m) block.rows.push_back({label, quantity_text(*length_m, "m")});
  };
  block.rows.push_back({"status", name_of(surface.status)});
  block.add("spacing", surface.spacing_m, "m");
  block.add("fine spacing", surface.fine_spacing_m, "m");
  if (surface.ridges > 0) block.rows.push_back({"ridges", std::to_string(surface.ridges)});
  add_length("scatter of the located ridges", surface.spacing_sd_m);
  block.add("spacing at the start", surface.begin_spacing_m, "m");
  block.add("spacing at the end", surface.end_spacing_m, "m");
  block.add("ridge height", surface.ridge_height, profile.height_in_metres ? "m" : "");
  if (surface.asymmetry) block.rows.push_back({"rise over fall", fmt::format("{:.2f}", *surface.asymmetry)});
  add_length("RSm", surface.rsm_m);
  add_length("cut-off wavelength of the waves", surface.cutoff_m);
  add_length("ridges smoothed over", surface.smoothed_over_m);
  return block;
}

std::string to_text(const Profile& profile, const Surface& surface) {
  return fmt::format("{}: {} points, pitch {}\n", profile.file, profile.height.size(),
                     quantity_text(profile.pitch_m, "m")) +
         text_of(pattern_block(profile, surface)) + warnings_text(surface.warnings) + assumed_text(profile.assumed);
}

}  // namespace slipfit
