#pragma once

#include <string>
#include <vector>

namespace slipfit {

struct FigureFile {
  std::string name;  ///< figure_7.csv, figure_7.svg, ...
  std::string content;
};

/// Returns figures 2 to 8 of the paper and the stability map, each as tables (CSV) and a picture (SVG); docs/figures.md
/// describes them. The bytes are always the same.
std::vector<FigureFile> paper_figures();

}  // namespace slipfit
