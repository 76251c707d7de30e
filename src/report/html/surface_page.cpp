#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/html/figure.hpp"
#include "report/html/markup.hpp"
#include "report/html/page.hpp"
#include "slipfit/report/surface.hpp"

namespace slipfit {
namespace html {
namespace {

struct ProfileUnits {
  DisplayUnit along;
  DisplayUnit height;
};

/// Lowest and highest of each of at most 1400 columns: as many as a line of the chart can show.
std::vector<chart::Point> drawn_profile(const Profile& profile, const ProfileUnits& units) {
  constexpr std::size_t kColumns = 1400;
  const std::size_t n = profile.height.size();
  const std::size_t width = 1 + (n - 1) / kColumns;
  std::vector<chart::Point> points;
  const auto add = [&](std::size_t i) {
    points.push_back(
        {static_cast<double>(i) * profile.pitch_m * units.along.per_SI, profile.height[i] * units.height.per_SI});
  };
  for (std::size_t begin = 0; begin < n; begin += width) {
    const auto first = profile.height.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = profile.height.begin() + static_cast<std::ptrdiff_t>(std::min(n, begin + width));
    const auto [low, high] = std::minmax_element(first, last);
    const auto a = static_cast<std::size_t>(std::min(low, high) - profile.height.begin());
    const auto b = static_cast<std::size_t>(std::max(low, high) - profile.height.begin());
    add(a);
    if (b != a) add(b);
  }
  return points;
}

/// Height of the profile at the sample next to a place.
double height_at(const Profile& profile, double place_m) {
  const auto last = static_cast<double>(profile.height.size() - 1);
  return profile.height[static_cast<std::size_t>(std::clamp(std::round(place_m / profile.pitch_m), 0.0, last))];
}

chart::Panel profile_panel(const Profile& profile, const Surface& surface, const ProfileUnits& units, double begin_m,
                           double end_m) {
  chart::Panel panel;
  chart::Line line{"profile", chart::Colour::Blue, chart::Stroke::Solid, {}, 1.0};
  double low = 1e300;
  double high = -1e300;
  Profile part = profile;
  const auto first = static_cast<std::ptrdiff_t>(begin_m / profile.pitch_m);
  const auto last = std::min(static_cast<std::ptrdiff_t>(profile.height.size()),
                             static_cast<std::ptrdiff_t>(end_m / profile.pitch_m) + 1);
  part.height.assign(profile.height.begin() + first, profile.height.begin() + last);
  for (chart::Point point : drawn_profile(part, units)) {
    point.x += begin_m * units.along.per_SI;
    if (std::isfinite(point.y)) {
      low = std::min(low, point.y);
      high = std::max(high, point.y);
    }
    line.points.push_back(point);
  }
  panel.lines.push_back(std::move(line));
  chart::Markers marks{fmt::format("{} ridges", surface.ridges), chart::Colour::Vermillion, chart::Shape::Triangle, {}};
  const double room = std::max(1e-300, high - low);
  for (const double place : surface.ridge_places_m) {
    if (place < begin_m || place > end_m) continue;
    marks.points.push_back({place * units.along.per_SI, height_at(profile, place) * units.height.per_SI + 0.04 * room});
  }
  if (!marks.points.empty()) panel.markers.push_back(std::move(marks));
  panel.x = {"place along the track (" + units.along.unit + ")", begin_m * units.along.per_SI,
             end_m * units.along.per_SI};
  panel.y = {units.height.unit.empty() ? "height (as in the file)" : "height (" + units.height.unit + ")",
             low - 0.05 * room, high + 0.15 * room};
  panel.height_px = 240.0;
  panel.legend_at = chart::LegendAt::Above;
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
      "The measured profile and the ridges that were counted: above the whole track, below its first twelve ridges.";
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
  return surface.status == SurfaceStatus::None ? "No pattern" : "Not known whether there is a pattern";
}

}  // namespace
}  // namespace html

std::string to_html(const Profile& profile, const Surface& surface, const std::string& command_line) {
  html::PageParts page;
  page.title = profile.file;
  page.kind = "surface";
  page.headline = html::surface_headline(surface);
  page.summary = html::warnings_part(surface.warnings);
  std::string numbers;
  std::string lines = to_text(profile, surface);
  for (std::size_t begin = 0; begin < lines.size();) {
    const std::size_t end = std::min(lines.find('\n', begin), lines.size());
    numbers += html::text(std::string_view(lines).substr(begin, end - begin)) + "\n";
    begin = end + 1;
  }
  page.main = html::figure_part(html::profile_figure(profile, surface)) +
              html::section(" id=\"numbers\"", "All numbers", "<pre>" + numbers + "</pre>\n") +
              html::section(" id=\"repeat\"", "To repeat this", html::fact_list(html::command_fact(command_line)));
  return html::page_from(page);
}

}  // namespace slipfit
