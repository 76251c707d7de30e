#pragma once

#include <cstddef>
#include <vector>

#include "fit/cycle/cycle_data.hpp"
#include "fit/cycle/cycle_model.hpp"
#include "fit/problem/block_fit.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit::fit {

/// Returns all scales but the span of time, which the cycles of the fit give.
Scales scales_of(const Recording& recording, const Quality& quality, const Segmentation& segmentation);

/// Median slope of the rises over the speed, N/m (or 1/m); 0 where no rise has two samples in its middle.
double stiffness_of(const Recording& recording, const Segmentation& segmentation);

/// Fills `fit.parameters` for the given shared ones from peaks, troughs and middles of the slips.
void set_start(BlockFit& fit, const Segmentation& segmentation, const Coordinates& start);

/// The cycles of a fit with weights for samples whose time is uncertain: a time off by dt is a force off by F' dt,
/// little in stick and much in slip. The noise comes from the sticks, the error of the times from what the slips have
/// more.
std::vector<CycleData> weigh_by_slope(const BlockFit& fit);

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
