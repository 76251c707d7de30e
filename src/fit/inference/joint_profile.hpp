#pragma once

#include "fit/inference/joint_quantities.hpp"
#include "fit/selection/joint_solution.hpp"

namespace slipfit::fit {

/// Where alpha is known badly the sum of squares is no parabola along it: alpha times zeta is known better than either,
/// and a second minimum may have the other sign. Refits with alpha held, out to where the sum of squares has risen by
/// the square of Student's quantile. Empty where alpha is known well by `covariance`, or held. `best`: the solution's
/// sweep_values.
RateProfile profile_of_rate(const SweepData& data, const JointSolution& solution, StaticFriction kind,
                            const SweepVector& best, const SweepMatrix& covariance, double degrees_of_freedom);

/// Where the best zeta is negative: moves the values to the best of the profile's with zeta >= 0, and lets the profile
/// lead from there to the others of these. Nothing where it has none.
void avoid_negative_damping(SweepVector& values, RateProfile& profile);

}  // namespace slipfit::fit
