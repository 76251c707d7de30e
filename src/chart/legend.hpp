#pragma once

#include "chart/chart.hpp"
#include "chart/drawing.hpp"

namespace slipfit::chart {

constexpr double kLineHeight_px = 18.0;

/// The room inside the axes of a panel, in pixels.
struct Frame {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;
};

/// Room that the legend takes above the axes; 0 where it stands inside them.
double legend_height_px(const Panel& panel, double width_px);

/// Everything with a name, in the order lines, markers, areas. `id`: of the picture.
void draw_legend(Drawing& drawing, const Panel& panel, const Frame& frame, const std::string& id);

}  // namespace slipfit::chart
