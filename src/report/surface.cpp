#include "slipfit/report/surface.hpp"

#include <fmt/format.h>

#include <array>
#include <numbers>

#include "core/unknown.hpp"
#include "report/format.hpp"
#include "report/json_sections.hpp"
#include "report/text_sections.hpp"

namespace slipfit {
namespace {

std::string surface_row(const char* name, const std::string& value) {
  return fmt::format("  {:<22} {}\n", name, value);
}

std::string estimate_of(const char* name, const Estimate& estimate, const std::string& unit) {
  return estimate.value ? surface_row(name, estimate_text(estimate, unit)) : std::string();
}

std::string length_of(const char* name, const std::optional<double>& length_m) {
  return length_m ? surface_row(name, quantity_text(*length_m, "m")) : std::string();
}

}  // namespace

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

std::string to_text(const Profile& profile, const Surface& surface) {
  std::string text = fmt::format("{}: {} points, pitch {}\n\nPattern\n", profile.file, profile.height.size(),
                                 quantity_text(profile.pitch_m, "m"));
  text += surface_row("status", name_of(surface.status));
  text += surface.spacing_m.value ? estimate_of("spacing", surface.spacing_m, "m")
                                  : surface_row("spacing", "not known: " + surface.spacing_m.note);
  text += estimate_of("fine spacing", surface.fine_spacing_m, "m");
  if (surface.ridges > 0) text += surface_row("ridges", fmt::format("{}", surface.ridges));
  text += length_of("scatter as located", surface.spacing_sd_m);
  text += estimate_of("spacing at the begin", surface.begin_spacing_m, "m");
  text += estimate_of("spacing at the end", surface.end_spacing_m, "m");
  text += estimate_of("ridge height", surface.ridge_height, profile.height_in_metres ? "m" : "");
  if (surface.asymmetry) text += surface_row("rise over fall", fmt::format("{:.2f}", *surface.asymmetry));
  text += length_of("RSm", surface.rsm_m);
  text += length_of("cut-off of the waves", surface.cutoff_m);
  text += length_of("ridges smoothed over", surface.smoothed_over_m);
  if (!surface.warnings.empty()) text += "\nWarnings\n";
  for (const Warning& warning : surface.warnings) text += fmt::format("  - {}: {}\n", warning.code, warning.message);
  return text + assumed_text(profile.assumed);
}

}  // namespace slipfit
