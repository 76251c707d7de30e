#include "fit/inference/load_response.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/fit_thresholds.hpp"
#include "core/line_sums.hpp"
#include "fit/inference/weighted_mean.hpp"

namespace slipfit::fit {

std::optional<LoadResponse> load_response(const Recording& recording, double kinetic_force, std::size_t cycles) {
  constexpr double kLeastError = 1e-6;  // no column is exact
  const std::span<const double> load_N = recording.normal_force_N();
  const std::span<const double> force = recording.force();
  if (load_N.empty() || recording.conditions().quantity != ForceQuantity::Force_N) return std::nullopt;
  const LineSums line = line_sums(
      force.size(), [&](std::size_t i) { return force[i]; }, [&](std::size_t i) { return load_N[i]; });
  if (!(line.square > 0.0) || !(line.at(kinetic_force) > 0.0)) return std::nullopt;
  const double friction_coefficient = kinetic_force / line.at(kinetic_force);
  // What the load does besides is of one cycle: noise, or the texture of the surface.
  const double error = line.slope_error() * std::sqrt(line.count / static_cast<double>(cycles));
  const LoadResponse response{friction_coefficient * line.slope(),
                              std::max(kLeastError, std::abs(friction_coefficient) * error), line.slope()};
  const bool is_clear = std::abs(response.share) > thresholds::kClearSigmas * response.standard_error &&
                        std::abs(response.share) > thresholds::kNegligible && response.share < 1.0;
  return is_clear ? std::optional(response) : std::nullopt;
}

LoadResponse mean_response(const std::vector<LoadResponse>& responses) {
  std::vector<Measured> shares, slopes;
  for (const LoadResponse& one : responses) {
    shares.push_back({one.share, one.standard_error});
    slopes.push_back({one.slope, one.standard_error * std::abs(one.slope / one.share)});
  }
  const WeightedMean share = weighted_mean(shares);
  return {share.value, share.standard_error, weighted_mean(slopes).value};
}

}  // namespace slipfit::fit
