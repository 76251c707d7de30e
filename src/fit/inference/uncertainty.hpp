#pragma once

#include <Eigen/Dense>

#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

/// The quantities whose joint covariance a fit gives, in this order. Onset force and level are means over the cycles of
/// the fit, in units of Scales::force.
enum Quantity : Eigen::Index { kLogStiffness, kLogFrequency, kDamping, kOnsetForce, kLevel, kQuantities };

struct Uncertainty {
  Eigen::MatrixXd covariance;                ///< kQuantities x kQuantities; rows of held parameters are 0
  Eigen::MatrixXd covariance_given_damping;  ///< the same with zeta held
  double degrees_of_freedom = 0.0;           ///< of Student's t for the intervals
  bool from_cycles = false;                  ///< jackknife over cycles (correlated residuals), else white noise
  bool from_refits = false;                  ///< refits (rounding, misfit) have their part in the covariances
  double noise = 0.0;                        ///< rms of the residuals, degrees of freedom counted
  double lag1_correlation = 0.0;             ///< of residuals of neighbouring samples, inside slips
  double lag1_pairs = 0.0;                   ///< how many pairs it is made of
  double chi2 = 0.0;  ///< sum of squares in units of Scales::noise^2, bins' inner scatter included
  double samples = 0.0;
  double onset_force_error = 0.0;  ///< of one cycle with the shared parameters known, white noise, same units
  double onset_force_sd = 0.0;     ///< spread of the onset force over cycles, in units of Scales::force
};

/// Residual variance over the noise's, degrees of freedom counted: all that a quick look needs.
double reduced_chi2(const BlockFit& fit);

/// The quantities at the solution.
Eigen::VectorXd quantities_of(const BlockFit& fit);

/// `continuous` as the solution was found. White-noise covariance where residuals are white, otherwise the delete-one
/// jackknife over cycles (cluster-robust CR3), which sees misfit and correlated noise alike.
Uncertainty estimate_uncertainty(const BlockFit& fit, const Held& held, bool continuous);

}  // namespace slipfit::fit
