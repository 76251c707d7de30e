#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <optional>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/fit/options.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/signal/cycles.hpp"

namespace slipfit::fit {

/// One cycle as a sensor at the contact sees it: a ramp up to F_s, a fall to F_k within a step of the clock, a plateau
/// while the body slips, a fall to the spring force (plus c V) within a step. Forces in the unit of the column.
struct ContactCycle {
  std::size_t slip = 0;     ///< index into the segmentation
  std::size_t onset = 0;    ///< last sample of the ramp before the slip
  std::size_t end = 0;      ///< last sample of the plateau
  double onset_s = 0.0;     ///< middle of the step in which the slip starts
  double end_s = 0.0;       ///< middle of the step in which it ends
  double plateau = 0.0;     ///< mean force of the slip: F_k
  double onset_jump = 0.0;  ///< ramp at the onset less the plateau: F_s - F_k
  double end_jump = 0.0;    ///< plateau less the ramp at the end
};

struct ContactCycles {
  std::vector<ContactCycle> cycles;
  std::size_t without_edges = 0;  ///< slips without two clear falls; the first and the last may be cut off
  double slope = 0.0;             ///< of the ramps, level's own slope taken off: k V
  double slope_error = 0.0;
  double drift = 0.0;  ///< the level's own slope; 0 where within its error
  double noise = 0.0;  ///< rms of ramps and plateaus about their lines
  double step_s = 0.0;
};

/// Finds the cycles of the contact; the result is empty below 3 cycles with both edges.
std::optional<ContactCycles> find_contact_cycles(const Recording& recording, const Segmentation& segmentation);

/// Holds the four means over the cycles with their errors: ln(k V), onset jump, end jump, slip time.
struct ContactMoments {
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  double jump_sd = 0.0;  ///< spread of the onset jump over cycles
};

ContactMoments moments_of(const ContactCycles& found);

/// (ln k V, ln w_n, zeta, ln (F_s - F_k)) and their covariance; zeta may come out slightly negative.
struct ContactSolution {
  Eigen::Vector4d value = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
};

/// Solves slip time and end jump of the model for w_n and zeta. Empty where no zeta in (-0.1, 0.6) does.
std::optional<ContactSolution> solve_moments(const ContactMoments& moments);

/// Fit of a recording whose sensor sits at the contact. Its force jumps at both ends of a slip, so that no sum of
/// squares has a smooth minimum; k, F_s - F_k, w_n and zeta follow from four means instead: slope of the ramps, both
/// jumps, duration of the slip. Empty below 3 cycles with both jumps, or where no damping ratio below 0.6 explains
/// them. `options.held` and `options.tier` do not apply: a warning says so.
std::optional<FitResult> fit_contact(const Recording& recording, const Segmentation& segmentation,
                                     const FitOptions& options);

}  // namespace slipfit::fit
