#include "slipfit/report/surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/unknown.hpp"
#include "report/blocks.hpp"
#include "report/html/figure.hpp"
#include "report/html/page.hpp"
#include "report/json_values.hpp"
#include "report/quantity_rows.hpp"

namespace slipfit {

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

namespace {

Block pattern_block(const Profile& profile, const Surface& surface) {
  Block block{"pattern", "Pattern"};
  block.rows.push_back({"status", std::string(name_of(surface.status))});
  if (surface.ridges > 0) block.rows.push_back({"ridges", std::to_string(surface.ridges)});
  block.add("ridge height", surface.ridge_height, profile.height_in_metres ? "m" : "");
  for (const auto& quantity : kPattern) {
    block.add(quantity.words, quantity.of(surface), std::string(quantity.unit));
  }
  return block;
}

}  // namespace

std::string to_text(const Profile& profile, const Surface& surface) {
  return fmt::format("{}: {} points, pitch {}\n", profile.file, profile.height.size(),
                     quantity_text(profile.pitch_m, "m")) +
         text_of(pattern_block(profile, surface)) + warnings_text(surface.warnings) + assumed_text(profile.assumed);
}

namespace html {
namespace {

struct ProfileUnits {
  DisplayUnit along;
  DisplayUnit height;
};

/// Height of the profile at the sample next to a place.
double height_at(const Profile& profile, double place_m) {
  const auto last = static_cast<double>(profile.height.size() - 1);
  return profile.height[static_cast<std::size_t>(std::clamp(std::round(place_m / profile.pitch_m), 0.0, last))];
}

chart::Panel profile_panel(const Profile& profile, const Surface& surface, const ProfileUnits& units, double begin_m,
                           double end_m) {
  constexpr std::size_t kMostColumns = 1400;  // as many as a line of the chart can show
  std::vector<double> places;
  std::vector<double> heights;
  for (auto i = static_cast<std::size_t>(begin_m / profile.pitch_m); i < profile.height.size(); ++i) {
    const double place_m = profile.pitch_m * static_cast<double>(i);
    if (place_m > end_m + 0.5 * profile.pitch_m) break;
    places.push_back(place_m * units.along.per_SI);
    heights.push_back(profile.height[i] * units.height.per_SI);
  }
  Span span;
  for (const double height : heights) span.add(height);
  chart::Markers marks{"located ridges", chart::Colour::Vermillion, chart::Shape::Triangle, {}};
  const double room = std::max(1e-300, span.range());
  for (const double place : surface.ridge_places_m) {
    if (place < begin_m || place > end_m) continue;
    marks.points.push_back({place * units.along.per_SI, height_at(profile, place) * units.height.per_SI + 0.04 * room});
  }
  chart::Panel panel{
      .x = {"position along the track (" + units.along.unit + ")", begin_m * units.along.per_SI,
            end_m * units.along.per_SI},
      .y = {units.height.unit.empty() ? "height (as in the file)" : "height (" + units.height.unit + ")",
            span.low() - 0.05 * room, span.high() + 0.15 * room},
      .height_px = 240.0,
      .lines = {{"profile", chart::Colour::Blue, chart::Stroke::Solid, envelope(places, heights, kMostColumns), 1.0}}};
  if (!marks.points.empty()) panel.markers.push_back(std::move(marks));
  return panel;
}

Figure profile_figure(const Profile& profile, const Surface& surface) {
  const double length_m = profile.pitch_m * static_cast<double>(profile.height.size() - 1);
  double swing = 0.0;
  for (const double h : profile.height) swing = std::isfinite(h) ? std::max(swing, std::abs(h)) : swing;
  const ProfileUnits units{display_unit("m", length_m),
                           profile.height_in_metres ? display_unit("m", swing) : DisplayUnit{1.0, ""}};
  Figure figure{"profile", "The profile"};
  figure.guide =
      "The measured profile and the located ridges: the whole track (top) and its first twelve ridges (bottom).";
  figure.label = "profile of the worn surface with its ridges marked";
  chart::Chart chart;
  chart.panels.push_back(profile_panel(profile, surface, units, 0.0, length_m));
  if (surface.spacing_m.value && surface.ridges > 16) {
    const double end_m = std::min(length_m, 12.5 * *surface.spacing_m.value + surface.ridge_places_m.front());
    chart.panels.push_back(profile_panel(profile, surface, units, 0.0, end_m));
  }
  figure.chart = std::move(chart);
  return figure;
}

std::string surface_headline(const Surface& surface) {
  if (surface.spacing_m.value) return text("Ridges every " + estimate_text(surface.spacing_m, "m"));
  return surface.status == SurfaceStatus::None ? "No pattern" : "Pattern not determined";
}

}  // namespace
}  // namespace html

std::string to_html(const Profile& profile, const Surface& surface, const std::string& command_line) {
  html::PageParts page;
  page.title = profile.file;
  page.kind = "surface";
  page.headline = html::surface_headline(surface);
  page.summary = html::warnings_part(surface.warnings);
  page.main = html::figure_part(html::profile_figure(profile, surface)) +
              html::block_part(pattern_block(profile, surface)) + html::repeat_part("", command_line, "");
  return html::page_from(page);
}

}  // namespace slipfit
