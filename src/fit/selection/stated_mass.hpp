#pragma once

#include <cmath>
#include <optional>

#include "fit/selection/solution.hpp"

namespace slipfit::fit {

/// Returns by how many of their common standard errors the stated mass exceeds k / w_n^2 of a fit; 0 where none is
/// stated or w_n is held.
double sigmas_of_stated_mass(const Conditions& conditions, const DampedFit& fit);

/// Returns whether a mass is stated that agrees with k / w_n^2 of a fit, or with a w_n that is held.
bool agrees_with_stated_mass(const Conditions& conditions, const DampedFit& fit);

/// A stated mass that gives the natural frequency, sqrt(k / m). kg > 0.
struct StatedMass {
  double kg = 0.0;
  double relative_error = 0.0;

  [[nodiscard]] double frequency_rad_per_s(double stiffness_N_per_m) const { return std::sqrt(stiffness_N_per_m / kg); }
};

/// Returns the stated mass where the samples are averaged over so much of a slip (thresholds::kHidingAverage) that
/// these hardly distinguish w_n and zeta. The result is empty where none is stated, w_n is held, or the average is
/// shorter.
std::optional<StatedMass> mass_for_frequency(const Conditions& conditions, const HeldParameters& held,
                                             double stiffness_N_per_m, double average_s);

/// A covariance found with w_n held, as it is with w_n = sqrt(k / m). `by_log_frequency`: what the coordinates move by.
CoordinateMatrix with_mass(const CoordinateMatrix& held, const Coordinates& by_log_frequency, double relative_error);

/// Returns `fit` with w_n by the recording's stated mass, where averaging obscures w_n and the slips do not contradict
/// it.
DampedFit fit_with_mass(const FitInput& input, DampedFit fit);

}  // namespace slipfit::fit
