#pragma once

#include <vector>

#include "slipfit/figures/figures.hpp"

// One function for each figure of the paper; each returns its tables and its picture.

namespace slipfit::figures {

std::vector<FigureFile> slip_and_stick_times();            // figure 2
std::vector<FigureFile> sticking_degree_and_amplitude();   // figure 3
std::vector<FigureFile> amplitude_against_speed();         // figure 4
std::vector<FigureFile> velocity_ratio();                  // figure 5
std::vector<FigureFile> spring_force();                    // figure 6
std::vector<FigureFile> damped_sticking_degree();          // figure 7
std::vector<FigureFile> damped_amplitude_against_speed();  // figure 8
std::vector<FigureFile> regime_map();

}  // namespace slipfit::figures
