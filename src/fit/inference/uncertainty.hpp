#pragma once

#include <Eigen/Dense>

#include "fit/inference/covariance.hpp"
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
Uncertainty estimate_uncertainty(const BlockFit& fit, const SolveOptions& solved);

}  // namespace slipfit::fit
