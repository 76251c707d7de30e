#pragma once

#include <string>
#include <vector>

namespace slipfit {

struct FigureFile {
  std::string name;  ///< figure_7.csv, figure_7.svg, ...
  std::string content;
};

/// Figures 2 to 8 of the paper and the map of regimes, each as tables (CSV) and a picture (SVG); docs/figures.md tells
/// what they show. The same bytes every time.
std::vector<FigureFile> paper_figures();

}  // namespace slipfit
