#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fit/selection/solution.hpp"
#include "fit/selection/stated_mass.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/fit/sweep_recording.hpp"

namespace slipfit::fit {

/// The recordings of a sweep, each on its own.
struct OwnFits {
  /// In the order of the recordings; empty: not of cycles, or none that can be fitted.
  std::vector<std::optional<DampedFit>> single;
  std::optional<FittedAverage> average{};   ///< in all fits of recordings that state none, and where a sweep begins
  std::optional<double> reload_length_m{};  ///< with which fits begin whose sticks rise more steeply after a slip
  /// sigma^2 up to which averaging that is not in the fits rounds their slips; empty: no sign of more than a step's
  std::optional<double> rounding_s2{};
  std::optional<StatedMass> mass{};  ///< that gives w_n
};

/// Returns the largest variance of averaging, in s^2, that all recordings allow together; empty where the averaging
/// does not exceed a step of the clock. All recordings of a machine average over the same time, so that they may
/// determine together what each alone does not.
std::optional<double> common_rounding_s2(std::span<const SweepRecording> recordings,
                                         const std::vector<std::optional<DampedFit>>& fits);

/// Fits each recording with what belongs to contact or machine, which is the same in all of them. Where some show a
/// rise after slips, all are fitted with one, its length to be found together. Where some that state no average show
/// one, and agree on it, all of these are fitted with the mean of it if half of them show it or they are explained
/// better together; otherwise what all of them show together is reported. Where averaging obscures w_n, a mass that all
/// state gives it. `known` is an average that was found before, instead of a search for it.
OwnFits fit_each(std::span<const SweepRecording> recordings, const HeldParameters& held,
                 const std::optional<FittedAverage>& known);

}  // namespace slipfit::fit
