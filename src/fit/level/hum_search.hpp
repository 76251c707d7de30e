#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fit/level/stick_ripple.hpp"
#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

/// Lines for the next fit.
struct HumSearch {
  std::vector<double> lines_Hz;
  bool others_wait = false;  ///< weaker ones, which the residuals of the next fit show, or show to be images
};

/// Returns the frequencies of the mains lines that are prominent in the residuals, of the strongest line at another
/// frequency where it is larger than the noise, and of the line in the sticks, unless they are in step with the slips.
/// Small hum is masked by the cycles' own spectrum, but not in the residuals. Lines that the fit has already are looked
/// at again, so that their frequency follows the better fit.
///
/// A line that is not fitted yet has images: at multiples of the slips' frequency from it, because cycles take up part
/// of it in numbers of their own, and near it where there are gaps between the fitted cycles. They go when the line is
/// fitted. So only lines are taken that are strong next to all other new ones and what is left of the known ones
/// (thresholds::kHumImage), and that nothing near exceeds by far.
///
/// `residuals`: one a sample (Residuals::value), handed over because a long recording has no room for a copy.
HumSearch find_hum(const Recording& recording, const BlockFit& fit, std::vector<double> residuals,
                   const std::vector<std::size_t>& outliers, const std::optional<StickRipple>& in_sticks);

/// Returns the frequencies at which the residuals of the fit, as for find_hum, have the lines that it has already.
std::vector<double> refine_hum(const Recording& recording, const BlockFit& fit, std::vector<double> residuals);

}  // namespace slipfit::fit
