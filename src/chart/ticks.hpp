#pragma once

#include <string>
#include <vector>

#include "chart/chart.hpp"

namespace slipfit::chart {

struct Tick {
  double value = 0.0;
  std::string text;  ///< empty: a grid line only
};

/// The axis as it can be drawn: finite ends in order, positive ones on a logarithmic axis, and so far apart that ticks
/// between them are different doubles.
Axis drawable(Axis axis);

/// Of a drawable axis. Steps of 1, 2 or 5 times a power of ten, at most `most_steps` of them; decades with their parts
/// on a logarithmic axis, all decades with values (of very many some) and, where the axis is short, some parts.
std::vector<Tick> ticks_of(const Axis& axis, int most_steps = 8);

}  // namespace slipfit::chart
