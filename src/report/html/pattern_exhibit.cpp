#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "report/html/exhibit.hpp"
#include "report/html/scaling.hpp"

namespace slipfit::html {
namespace {

using chart::Area, chart::Colour, chart::Panel;

constexpr std::size_t kMostRidges = 14;
constexpr int kShades = 5;              // steps from the flank to the crest
constexpr double kCrest = 0.85;         // where the crest lies between two slips: ridges lean against the sliding
constexpr std::size_t kMostFine = 200;  // finer ones would be a grey area

/// Distances between neighbouring ridges: the spacing, scattered as the recording's own intervals between slips do.
std::vector<double> ridge_distances_m(const Analysis& analysis, double spacing_m) {
  std::vector<double> intervals;
  const std::vector<Cycle>& cycles = analysis.cycle_table;
  for (std::size_t i = 1; i < cycles.size(); ++i) {
    intervals.push_back(cycles[i].onset_s.value_or(cycles[i].peak_s) -
                        cycles[i - 1].onset_s.value_or(cycles[i - 1].peak_s));
  }
  const std::size_t count = std::min(kMostRidges, intervals.size());
  const std::size_t first = (intervals.size() - count) / 2;
  std::vector<double> distances(intervals.begin() + static_cast<std::ptrdiff_t>(first),
                                intervals.begin() + static_cast<std::ptrdiff_t>(first + count));
  if (distances.empty()) return distances;
  const double mean = std::accumulate(intervals.begin(), intervals.end(), 0.0) / static_cast<double>(intervals.size());
  for (double& distance : distances) distance *= spacing_m / mean;
  return distances;
}

Area band(double from, double to) {
  return {"", Colour::Black, chart::Fill::Plain, {{from, 0.0}, {from, 1.0}, {to, 1.0}, {to, 0.0}}};
}

/// One ridge seen from above: darker towards its crest.
void add_ridge(Panel& panel, double begin, double end) {
  const double crest = begin + kCrest * (end - begin);
  for (int shade = 1; shade <= kShades; ++shade) {
    const double part = static_cast<double>(shade) / (kShades + 1);
    panel.areas.push_back(band(begin + part * (crest - begin), end - part * (end - crest)));
  }
}

Panel strip(const std::string& name, const std::string& unit, double length) {
  Panel panel;
  panel.height_px = 70.0;
  panel.x = {label_with_unit(name, unit), 0.0, length, chart::Scale::Linear};
  panel.y = {"", 0.0, 1.0, chart::Scale::Linear};
  return panel;
}

Panel fine_strip(double spacing, double length, const std::string& unit) {
  Panel panel = strip("path, fine pattern (an estimate)", unit, length);
  panel.height_px = 40.0;
  for (double at = 0.0; at < length; at += spacing) panel.areas.push_back(band(at + 0.5 * spacing, at + spacing));
  return panel;
}

}  // namespace

Exhibit pattern_exhibit(const Source& source) {
  Exhibit exhibit{"pattern", "The abrasion pattern as it would look", {}, {}, {}, {}};
  const Derived& derived = source.analysis.derived;
  const bool is_predicted = derived.periodic_displacement_m.value.has_value();
  const Estimate& spacing = is_predicted ? derived.periodic_displacement_m : derived.pattern_spacing_m;
  const bool has_ridges = source.analysis.verdict == Verdict::StickSlip && spacing.value;
  const std::vector<double> distances_m =
      has_ridges ? ridge_distances_m(source.analysis, *spacing.value) : std::vector<double>{};
  if (distances_m.empty()) {
    exhibit.absent = "Without stick-slip there is no pattern to draw.";
    return exhibit;
  }
  const double length_m = std::accumulate(distances_m.begin(), distances_m.end(), 0.0);
  const DisplayUnit unit = display_unit("m", 0.2 * length_m);
  const double per_SI = unit.per_SI;
  Panel coarse = strip("path, coarse pattern (stick-slip)", unit.unit, per_SI * length_m);
  double at = 0.0;
  for (const double distance_m : distances_m) {
    add_ridge(coarse, at, at + per_SI * distance_m);
    at += per_SI * distance_m;
  }
  exhibit.chart = chart::Chart{"Abrasion pattern, to scale", {}, {coarse}};
  const std::string source_words = is_predicted ? "predicted by the fitted model" : "measured (V/f)";
  exhibit.guide = fmt::format(
      "The surface from above, one ridge a slip, along the path to scale: mean spacing {}, {}, with the scatter of "
      "this "
      "recording's slips. The height of the ridges and their shape are not predicted; they are drawn alike.",
      quantity_of(spacing, "m"), source_words);
  const Estimate& fine = derived.micro_vibration_spacing_m;
  if (fine.value && *fine.value > 0.0 && length_m / *fine.value < static_cast<double>(kMostFine)) {
    exhibit.chart->panels.push_back(fine_strip(per_SI * *fine.value, per_SI * length_m, unit.unit));
    exhibit.guide += fmt::format(
        " The fine pattern below, spacing {}, is an estimate from the free oscillation: the model has no "
        "micro-vibration inside a slip.",
        quantity_of(fine, "m"));
  }
  exhibit.label = fmt::format("abrasion pattern from above, {} ridges, mean spacing {}", distances_m.size(),
                              quantity_of(spacing, "m"));
  return exhibit;
}

}  // namespace slipfit::html
