#pragma once

#include <Eigen/Core>
#include <Eigen/Dense>
#include <cstddef>
#include <optional>

#include "fit/inference/covariance.hpp"
#include "fit/problem/block_fit.hpp"
#include "fit/problem/solve.hpp"

namespace slipfit::fit {

/// Holds the moves of the coordinates by refits, one a row.
using Moves = Eigen::Matrix<double, Eigen::Dynamic, kCoordinates>;

struct Uncertainty {
  CoordinateMatrix covariance = CoordinateMatrix::Zero();  ///< rows of what is held or absent are 0
  double degrees_of_freedom = 0.0;                         ///< of Student's t for the intervals
  bool from_cycles = false;       ///< jackknife over cycles (correlated residuals), else white noise
  bool from_refits = false;       ///< refits (rounding, misfit) have their part in the covariances
  double noise = 0.0;             ///< rms of the residuals, degrees of freedom counted
  double lag1_correlation = 0.0;  ///< of residuals of neighbouring samples, inside slips
  double lag1_pairs = 0.0;        ///< how many pairs it is made of
  double chi2 = 0.0;              ///< sum of squares in units of Scales::noise^2, bins' inner scatter included
  double samples = 0.0;
  double onset_force_error = 0.0;  ///< of one cycle with the shared parameters known, white noise, same units
  double onset_force_sd = 0.0;     ///< spread of the onset force over cycles, in units of Scales::force
};

/// Residual variance over the noise's, degrees of freedom counted: all that a quick look needs.
double reduced_chi2(const BlockFit& fit);

/// The coordinates of one recording at its solution: F_s - F_k and level are means over the cycles of the fit.
Coordinates coordinates_of(const BlockFit& fit);

/// Their derivatives with respect to the fit's parameters.
Selection select(const BlockFit& fit);

/// Held and continuous as the solution was found. White-noise covariance where residuals are white, otherwise the
/// delete-one jackknife over cycles (cluster-robust CR3), which sees misfit and correlated noise alike.
Uncertainty estimate_uncertainty(const BlockFit& fit, const Solved& solved);

/// Stretches of equal length from shortly before a slip to shortly after it.
inline constexpr int kSegments = 8;

/// Says where in a slip residuals are the same in every cycle, and how large they are.
struct SegmentMisfit {
  double position = 0.0;  ///< middle of the worst stretch: 0 at the onset, 1 at the end of slip
  double size = 0.0;      ///< mean residual there over the mean onset force, signed
  double chance = 1.0;    ///< of a mean as far from 0 in one of the stretches, by Student's t over the cycles
};

/// Stretch of a sample; empty outside all.
std::optional<std::size_t> segment_of(const CycleState& state, double time_s);

/// Stacks residuals over the segments of the slip. The result is empty where no stretch has a mean that exceeds chance
/// (4.5 standard errors over the cycles) and matters (1 % of the onset force, `tolerated` on top), and below 5 cycles.
std::optional<SegmentMisfit> find_misfit(const BlockFit& fit, double tolerated);

/// Root mean square over the stretches of a slip, over the mean onset force.
struct StackedResidual {
  double size = 0.0;       ///< of the mean residuals over the cycles
  double by_chance = 0.0;  ///< of their standard errors
};

/// The stretches are those of the slips of `phases`, a fit of the same recording or of more of its cycles: two fits
/// compare on the same samples.
StackedResidual stacked_residual(const BlockFit& fit, const BlockFit& phases);

/// Adds the jackknife over the stretches: what the estimates owe to one part of the slip alone. Each row of `moves`:
/// what a refit without one stretch moves the coordinates by.
Uncertainty with_misfit(Uncertainty uncertainty, const Moves& moves);

/// Returns the moves of the coordinates by leaving out one stretch of the slips: a row for each stretch
/// without which the shared parameters can still be determined. It takes one Gauss-Newton step from the solution
/// instead of a refit: within a tenth of it, where the result is a spread that widens intervals. Joined ramps are let
/// go, which makes the moves larger if anything.
Moves influence_of_segments(const BlockFit& fit, const Held& held);

}  // namespace slipfit::fit
