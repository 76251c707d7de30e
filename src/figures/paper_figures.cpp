#include <iterator>

#include "figures/parts.hpp"
#include "slipfit/figures/figures.hpp"

namespace slipfit {

std::vector<FigureFile> paper_figures() {
  std::vector<FigureFile> files;
  for (const auto figure :
       {figures::slip_and_stick_times, figures::sticking_degree_and_amplitude, figures::amplitude_against_speed,
        figures::velocity_ratio, figures::spring_force, figures::damped_sticking_degree,
        figures::damped_amplitude_against_speed, figures::regime_map}) {
    std::vector<FigureFile> part = figure();
    files.insert(files.end(), std::make_move_iterator(part.begin()), std::make_move_iterator(part.end()));
  }
  return files;
}

}  // namespace slipfit
