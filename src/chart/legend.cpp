#include "chart/drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

namespace slipfit::chart {
namespace {

// Pixels.
constexpr double kCharacter = 6.6;  // mean width of a letter at 12 px
constexpr double kSample = 26.0;    // length of a line in the legend
constexpr double kGap = 22.0;       // between two entries in a row

struct Entry {
  std::string name;
  std::variant<const Line*, const Markers*, const Area*> what;

  [[nodiscard]] double width() const { return kSample + kGap + kCharacter * letters_in(name); }
};

std::vector<Entry> entries_of(const Panel& panel) {
  std::vector<Entry> entries;
  if (panel.legend_at == LegendAt::None) return entries;
  for (const Line& line : panel.lines) entries.push_back({line.name, &line});
  for (const Markers& markers : panel.markers) entries.push_back({markers.name, &markers});
  for (const Area& area : panel.areas) entries.push_back({area.name, &area});
  std::erase_if(entries, [](const Entry& entry) { return entry.name.empty(); });
  return entries;
}

struct Spot {
  double x = 0.0;
  double y = 0.0;
};

/// `spot`: left end of the sample, middle of the row.
void draw_sample(Drawing& drawing, const Entry& entry, Spot spot, const std::string& id) {
  if (const auto* line = std::get_if<const Line*>(&entry.what)) {
    drawing.line(spot.x, spot.y, spot.x + kSample, spot.y, drawing.stroke_style(**line));
  } else if (const auto* markers = std::get_if<const Markers*>(&entry.what)) {
    drawing.markers({{spot.x + 0.5 * kSample, spot.y}}, (*markers)->colour, (*markers)->shape);
  } else if (const auto* area = std::get_if<const Area*>(&entry.what)) {
    drawing.box(spot.x, spot.y - 6.0, kSample, 12.0, drawing.area_style(**area, id));
  }
}

void draw_entry(Drawing& drawing, const Entry& entry, Spot spot, const std::string& id) {
  drawing.text(spot.x + kSample + 7.0, spot.y + 4.0, entry.name, "value");
  draw_sample(drawing, entry, spot, id);
}

/// Returns the position of each entry of a legend above the axes, from the upper left corner; a full row starts another
/// one.
std::vector<Spot> rows_of(const std::vector<Entry>& entries, double width_px) {
  std::vector<Spot> spots;
  Spot next;
  for (const Entry& entry : entries) {
    if (next.x > 0.0 && next.x + entry.width() - kGap > width_px) next = {0.0, next.y + kLineHeight_px};
    spots.push_back(next);
    next.x += entry.width();
  }
  return spots;
}

}  // namespace

double legend_height_px(const Panel& panel, double width_px) {
  const std::vector<Entry> entries = entries_of(panel);
  if (entries.empty()) return 0.0;
  return rows_of(entries, width_px).back().y + kLineHeight_px + 6.0;
}

void draw_legend(Drawing& drawing, const Panel& panel, const Frame& frame, const std::string& id) {
  const std::vector<Entry> entries = entries_of(panel);
  if (entries.empty()) return;
  const double top = frame.top - legend_height_px(panel, frame.width) + 0.5 * kLineHeight_px;
  const std::vector<Spot> spots = rows_of(entries, frame.width);
  drawing.raw("<g class=\"entries\">\n");
  for (std::size_t i = 0; i < entries.size(); ++i) {
    draw_entry(drawing, entries[i], {frame.left + spots[i].x, top + spots[i].y}, id);
  }
  drawing.raw("</g>\n");
}

std::string to_page_legend(const Chart& chart, const std::string& id) {
  constexpr double kHeight = 14.0;
  std::string rows;
  std::vector<std::string> names;
  for (const Panel& panel : chart.panels) {
    if (panel.legend_at != LegendAt::Above) continue;
    for (const Entry& entry : entries_of(panel)) {
      if (std::ranges::find(names, entry.name) != names.end()) continue;
      if (&panel != &chart.panels.front()) return {};
      names.push_back(entry.name);
      Drawing sample(Palette::Page);
      draw_sample(sample, entry, {0.0, 0.5 * kHeight}, id + "-");
      rows += fmt::format("<li><svg width=\"{0:.0f}\" height=\"{1:.0f}\" aria-hidden=\"true\">{2}</svg>{3}</li>\n",
                          kSample, kHeight, sample.svg(), escaped(entry.name));
    }
  }
  return rows.empty() ? rows : "<ul class=\"legend-list\">\n" + rows + "</ul>\n";
}

}  // namespace slipfit::chart
