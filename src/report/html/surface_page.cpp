#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/html/figure.hpp"
#include "report/html/page.hpp"
#include "slipfit/report/surface.hpp"

namespace slipfit {
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
  chart::Line line{"profile", chart::Colour::Blue, chart::Stroke::Solid, envelope(places, heights, kMostColumns), 1.0};
  Span span;
  for (const double height : heights) span.add(height);
  chart::Panel panel;
  panel.lines.push_back(std::move(line));
  chart::Markers marks{"located ridges", chart::Colour::Vermillion, chart::Shape::Triangle, {}};
  const double room = std::max(1e-300, span.range());
  for (const double place : surface.ridge_places_m) {
    if (place < begin_m || place > end_m) continue;
    marks.points.push_back({place * units.along.per_SI, height_at(profile, place) * units.height.per_SI + 0.04 * room});
  }
  if (!marks.points.empty()) panel.markers.push_back(std::move(marks));
  panel.x = {"position along the track (" + units.along.unit + ")", begin_m * units.along.per_SI,
             end_m * units.along.per_SI};
  panel.y = {units.height.unit.empty() ? "height (as in the file)" : "height (" + units.height.unit + ")",
             span.low() - 0.05 * room, span.high() + 0.15 * room};
  panel.height_px = 240.0;
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
