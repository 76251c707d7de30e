#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/statistics.hpp"
#include "report/html/figure.hpp"

namespace slipfit::html {
namespace {

using chart::Colour, chart::Panel, chart::Point, chart::Stroke;

constexpr double kLowestZeta = 1e-3;
constexpr double kHighestZeta = 3.0;

/// The recording on the map; intervals as far as they are known.
struct Spot {
  Estimate lambda;
  Estimate zeta;
};

Spot spot_of(const Analysis& analysis) {
  Spot spot{analysis.derived.lambda, {}};
  if (!analysis.fit) return spot;
  const Parameter* const zeta = analysis.fit->find(ParameterId::DampingRatio);
  if (zeta != nullptr && zeta->status != ParameterStatus::Bounded) spot.zeta = zeta->estimate;
  return spot;
}

chart::Panel regions(const std::vector<LimitPoint>& limit, double left, double right) {
  chart::Line exact{"exact limit of stick-slip", Colour::Black, Stroke::Solid, {}};
  for (const LimitPoint& point : limit) exact.points.push_back({point.lambda, point.damping_ratio});
  std::vector<Point> stick_slip = exact.points;
  stick_slip.push_back({right, 1.0});
  stick_slip.push_back({right, kLowestZeta});
  const auto note = [left, right](double place, double zeta, const char* words) {
    return chart::Note{{left * std::pow(right / left, place), zeta}, words, Colour::Black, 0.0, -1.0};
  };
  return {
      .x = {"stick-slip parameter λ = ωₙ (Fₛ − Fₖ) / (k V)  [-]", left, right, chart::Scale::Logarithmic},
      .y = {"damping ratio ζ  [-]", kLowestZeta, kHighestZeta, chart::Scale::Logarithmic},
      .height_px = 340.0,
      .areas = {{"", Colour::SkyBlue, chart::Fill::Plain, stick_slip, kEdge_px},
                rectangle("", Colour::Grey, {left, 1.0}, {right, kHighestZeta})},
      .lines = {exact},
      .notes = {note(0.8, 0.004, "stick-slip"), note(0.12, 0.3, "no stick-slip"), note(0.5, 1.6, "overdamped, ζ ≥ 1")}};
}

/// Bars that reach over the 95 % intervals.
void add_spot(chart::Panel& panel, const Spot& spot) {
  const double lambda = *spot.lambda.value;
  const double zeta = std::max(*spot.zeta.value, kLowestZeta);
  panel.markers.push_back({"this recording", Colour::Vermillion, chart::Shape::Dot, {{lambda, zeta}}});
  const auto bar = [&panel](Point from, Point to) {
    const char* name = panel.lines.size() == 1 ? "95 % intervals" : "";
    panel.lines.push_back({name, Colour::Vermillion, Stroke::Solid, {from, to}, 2.4});
  };
  if (spot.lambda.ci95) bar({spot.lambda.ci95->low, zeta}, {spot.lambda.ci95->high, zeta});
  if (spot.zeta.ci95) {
    bar({lambda, std::max(spot.zeta.ci95->low, kLowestZeta)}, {lambda, std::max(spot.zeta.ci95->high, kLowestZeta)});
  }
}

}  // namespace

Figure map_figure(const Source& source) {
  Figure figure{"map", "Stability map"};
  figure.guide =
      "To the right of the line a body that starts from rest continues to stick and slip, to the left the motion "
      "decays. A higher speed moves the point to the left (lambda is proportional to 1/V). The bars are the 95 % "
      "intervals; a damping ratio below 0.001 is drawn at the lower edge.";
  const Spot spot = spot_of(source.analysis);
  if (!spot.lambda.value || !spot.zeta.value || !(*spot.lambda.value > 0.0)) {
    const std::string& why = spot.lambda.value ? spot.zeta.note : spot.lambda.note;
    return figure.without_chart("The position on the map is unknown" + (why.empty() ? std::string() : ": " + why) +
                                ".");
  }
  const double lambda = *spot.lambda.value;
  chart::Panel panel = regions(source.background.limit, std::min(0.01, 0.3 * lambda), std::max(100.0, 3.0 * lambda));
  add_spot(panel, spot);
  figure.chart = chart::Chart{"Stability map", {}, {panel}};
  figure.label = fmt::format(
      "map of damping ratio against lambda with the limit of stick-slip; this recording is at lambda {}, damping ratio "
      "{}",
      estimate_row(spot.lambda, "").value, estimate_row(spot.zeta, "").value);
  return figure;
}

namespace {

constexpr std::size_t kMostRidges = 14;
constexpr int kShades = 5;              // steps from the flank to the crest
constexpr double kCrest = 0.85;         // where the crest lies between two slips: ridges lean against the sliding
constexpr std::size_t kMostFine = 200;  // finer ones would be a grey area

/// Distances between neighbouring ridges: the spacing, scattered as the recording's own intervals between slips do.
std::vector<double> ridge_distances_m(const Analysis& analysis, double spacing_m) {
  std::vector<double> intervals;
  const std::vector<Cycle>& cycles = analysis.cycle_table;
  for (std::size_t i = 1; i < cycles.size(); ++i) {
    intervals.push_back(slip_begin_s(cycles[i]) - slip_begin_s(cycles[i - 1]));
  }
  const std::size_t count = std::min(kMostRidges, intervals.size());
  const std::size_t first = (intervals.size() - count) / 2;
  std::vector<double> distances(intervals.begin() + static_cast<std::ptrdiff_t>(first),
                                intervals.begin() + static_cast<std::ptrdiff_t>(first + count));
  if (distances.empty()) return distances;
  const double mean = mean_of(intervals);
  for (double& distance : distances) distance *= spacing_m / mean;
  return distances;
}

/// Adds a rectangle to an area. Without an edge: the shades of a ridge lie over each other.
void shade_between(chart::Area& area, double begin, double end) {
  const std::vector<Point> outline = rectangle("", Colour::Black, {begin, 0.0}, {end, 1.0}).outline;
  area.outline.insert(area.outline.end(), outline.begin(), outline.end());
  constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
  area.outline.push_back({kGap, kGap});
}

/// The ridges seen from above, darker towards their crests: an area for each shade.
void add_ridges(Panel& panel, const std::vector<double>& lengths) {
  for (int shade = 1; shade <= kShades; ++shade) {
    const double part = static_cast<double>(shade) / (kShades + 1);
    chart::Area area{"", Colour::Black, chart::Fill::Plain, {}};
    double begin = 0.0;
    for (const double length : lengths) {
      const double crest = begin + kCrest * length;
      shade_between(area, begin + part * (crest - begin), begin + length - part * (begin + length - crest));
      begin += length;
    }
    panel.areas.push_back(std::move(area));
  }
}

Panel strip(const std::string& name, const std::string& unit, double length) {
  return {.x = {label_with_unit(name, unit), 0.0, length}, .y = {"", 0.0, 1.0}, .height_px = 70.0};
}

Panel fine_strip(double spacing, double length, const std::string& unit) {
  Panel panel = strip("path, fine pattern (an estimate)", unit, length);
  panel.height_px = 40.0;
  chart::Area area{"", Colour::Black, chart::Fill::Plain, {}};
  for (double at = 0.0; at < length; at += spacing) shade_between(area, at + 0.5 * spacing, at + spacing);
  panel.areas.push_back(std::move(area));
  return panel;
}

/// Returns a panel with as much of the measured profile as the pattern above it is long, at the same scale; it starts
/// at a ridge.
Panel track_strip(const WornTrack& track, double length, const DisplayUnit& unit) {
  Panel panel = strip("measured profile of the worn track", unit.unit, length);
  panel.height_px = 110.0;
  const double first_m = track.ridge_places_m.empty() ? 0.0 : track.ridge_places_m.front();
  chart::Line line{"", Colour::Blue, chart::Stroke::Solid, {}, 1.0};
  Span heights;
  for (auto i = static_cast<std::size_t>(first_m / track.pitch_m); i < track.height.size(); ++i) {
    const double at = unit.per_SI * (track.pitch_m * static_cast<double>(i) - first_m);
    if (at > length) break;
    line.points.push_back({at, track.height[i]});
    heights.add(track.height[i]);
  }
  if (!(heights.range() > 0.0)) return panel;
  for (chart::Point& point : line.points) point.y = 0.05 + 0.9 * (point.y - heights.low()) / heights.range();
  panel.lines.push_back(std::move(line));
  return panel;
}

void add_track(Figure& figure, const Source& source, double length, const DisplayUnit& unit) {
  const auto& track = source.recording.conditions().worn_track;
  if (!track) return;
  figure.chart->panels.push_back(track_strip(*track, length, unit));
  figure.guide += " Below it, to the same scale, the measured profile of the worn track: " +
                  source.analysis.derived.surface_verdict + ".";
}

}  // namespace

Figure pattern_figure(const Source& source) {
  Figure figure{"pattern", "Predicted abrasion pattern"};
  const Derived& derived = source.analysis.derived;
  const bool is_predicted = derived.periodic_displacement_m.value.has_value();
  const Estimate& spacing = is_predicted ? derived.periodic_displacement_m : derived.pattern_spacing_m;
  const bool has_ridges = source.analysis.motion == MotionClass::StickSlip && spacing.value;
  const std::vector<double> distances_m =
      has_ridges ? ridge_distances_m(source.analysis, *spacing.value) : std::vector<double>{};
  if (distances_m.empty()) return figure.without_chart("Without stick-slip there is no pattern to draw.");
  const double length_m = std::accumulate(distances_m.begin(), distances_m.end(), 0.0);
  const DisplayUnit unit = display_unit("m", 0.2 * length_m);
  const double per_SI = unit.per_SI;
  Panel coarse = strip("path, coarse pattern (stick-slip)", unit.unit, per_SI * length_m);
  std::vector<double> lengths;
  lengths.reserve(distances_m.size());
  for (const double distance_m : distances_m) lengths.push_back(per_SI * distance_m);
  add_ridges(coarse, lengths);
  figure.chart = chart::Chart{"Abrasion pattern, to scale", {}, {coarse}};
  const std::string source_words = is_predicted ? "predicted by the fitted model" : "measured (V/f)";
  figure.guide = fmt::format(
      "The surface from above, one ridge for each slip, to scale along the path: mean spacing {}, {}, with the scatter "
      "of the slips of this recording. Height and shape of the ridges are not predicted.",
      quantity_of(spacing, "m"), source_words);
  add_track(figure, source, per_SI * length_m, unit);
  const Estimate& fine = derived.micro_vibration_spacing_m;
  if (fine.value && *fine.value > 0.0 && length_m / *fine.value < static_cast<double>(kMostFine)) {
    figure.chart->panels.push_back(fine_strip(per_SI * *fine.value, per_SI * length_m, unit.unit));
    figure.guide += fmt::format(
        " The fine pattern below, spacing {}, is an estimate from the free oscillation: the model contains no "
        "micro-vibration within a slip.",
        quantity_of(fine, "m"));
  }
  figure.label = fmt::format("abrasion pattern from above, {} ridges, mean spacing {}", distances_m.size(),
                             quantity_of(spacing, "m"));
  return figure;
}

}  // namespace slipfit::html
