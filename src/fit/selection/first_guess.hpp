#pragma once

#include <cstddef>
#include <vector>

#include "fit/cycle/cycle_data.hpp"
#include "fit/cycle/cycle_model.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/signal/cycles.hpp"

namespace slipfit::fit {

/// A slip lasts 2 (pi - atan lambda) / w_n around its middle; 0.3 half periods on either side are left for the fit to
/// move its ends.
double half_width_s(double stiffness_N_per_m, const Scales& scales);

/// A level of its own in every cycle cannot be distinguished from a polynomial with fewer cycles than this.
inline constexpr std::size_t kFewestWandering = 12;

/// The level model to begin with: the polynomial that the middles of the slips justify, or one level a cycle.
LevelModel first_level(const Recording& recording, const Segmentation& segmentation,
                       const std::vector<CycleData>& cycles, const Scales& scales);

/// Middles of the cycles' slips.
std::vector<double> middles_s(const Segmentation& segmentation, const std::vector<CycleData>& cycles);

/// Returns the starting values of the search: several frequencies where the fall is hardly sampled or drawn out.
std::vector<Coordinates> first_values(double stiffness_N_per_m, const HeldParameters& held, const Scales& scales,
                                      double step_s);

}  // namespace slipfit::fit
