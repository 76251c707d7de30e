#pragma once

#include <optional>

#include "fit/selection/tiers.hpp"
#include "slipfit/fit/parameter.hpp"

namespace slipfit::fit {

/// A recording as fits see it.
struct FitInput {
  const Recording& recording;
  const Quality& quality;
  const Segmentation& segmentation;
  const HeldParameters& held;
};

/// `missed`: stacked residual of the Coulomb fit, where the law is to be taken for halving it alone; empty: it is
/// fitted to all cycles, whatever some of them show. Empty where no start converges, where some of the cycles show that
/// it will not be taken or where the cycles do not tell the shared parameters apart.
std::optional<DampedFit> fit_weakening(const FitInput& input, const DampedFit& coulomb, std::optional<double> missed);

/// The same seen through an average of the sensor that is one parameter more, from `average_s` on. Empty where no start
/// converges, and where some of the cycles show that it explains them no better than `rival`, a fit with one of the
/// two.
std::optional<DampedFit> fit_averaged_weakening(const FitInput& input, const DampedFit& coulomb, double average_s,
                                                const DampedFit& rival);

}  // namespace slipfit::fit
