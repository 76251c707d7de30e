#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <optional>

#include "fit/inference/profile.hpp"
#include "fit/selection/ramps.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {

/// A linear function of the fitted quantities near the solution, with what it owes to zeta.
struct Linear {
  double value = 0.0;
  double se = 0.0;
  double se_given_damping = 0.0;
  double move_low = 0.0;  ///< from the solution to the low end of zeta's interval
  double move_high = 0.0;
  double degrees_of_freedom = 1.0;
};

/// One quantity of Quantity, scaled.
Eigen::VectorXd unit_gradient(Eigen::Index quantity, double size = 1.0);

/// The best fit with zeta >= 0 as physical numbers, and how what follows from them is uncertain.
class Solution {
 public:
  Solution(const Recording& recording, const TierFits& fits, const Resolution& resolution);

  /// `variance`: added to what the fit is uncertain by (scatter of the cycles).
  [[nodiscard]] Linear linear(double value, const Eigen::VectorXd& gradient, double variance) const;
  [[nodiscard]] Estimate estimate(const Linear& y) const;
  /// Of a mean over the cycles: with cycles as the units of resampling the scatter is already in the covariance.
  [[nodiscard]] double scatter_variance(double spread) const;

  const Uncertainty& uncertainty;
  Held held;  ///< by the user
  std::size_t cycles = 0;
  double stiffness = 0.0;  ///< N/m, or 1/m of a friction coefficient
  double omega = 0.0;      ///< rad/s
  double zeta = 0.0;
  double force = 1.0;  ///< Scales::force, unit of the quantities kOnsetForce and kLevel
  double scale = 0.0;  ///< u = k V / w_n
  double onset_force = 0.0;
  double level = 0.0;
  double onset_force_sd = 0.0;
  double damping_se = 0.0;
  Interval damping_ci;
  double relative_speed_se = 0.0;  ///< of the stated speed; 0 where it counts as exact
  double level_trend = 0.0;        ///< of levels of their own, force a second
  std::optional<RampBend> bend;    ///< where it is no chance
  bool shape_refused = false;      ///< slips are not shaped like the model's

 private:
  const BlockFit& choose_blocks(const TierFits& fits);
  void bound_damping(const TierFits& fits, const Resolution& resolution, const BlockFit& blocks);

  Eigen::MatrixXd given_damping_;
  bool at_bound_ = false;
  std::optional<DampingProfile> profile_;
};

}  // namespace slipfit::fit
