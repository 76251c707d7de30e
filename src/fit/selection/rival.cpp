#include "fit/selection/rival.hpp"

#include <algorithm>
#include <cmath>

namespace slipfit::fit {

DampedFit widened_by_rival(DampedFit fit, const DampedFit& other) {
  const CoordinateMatrix own = fit.uncertainty.covariance;
  CoordinateMatrix wide = other.uncertainty.covariance;
  for (Eigen::Index i = 0; i < kCoordinates; ++i) {
    const bool is_shared = own(i, i) > 0.0 && wide(i, i) > 0.0;
    const double scale = is_shared ? std::sqrt(std::max(1.0, own(i, i) / wide(i, i))) : 0.0;
    wide.row(i) *= scale;
    wide.col(i) *= scale;
    if (!is_shared) wide(i, i) = own(i, i);
  }
  if (fit.average && other.average) {
    double& error_s = fit.average->standard_error_s;
    error_s = std::hypot(error_s, other.average->seconds - fit.average->seconds);
  }
  fit.rivals.push_back(coordinates_of(other.blocks));
  fit.uncertainty.covariance = wide;
  fit.uncertainty.degrees_of_freedom =
      std::min(fit.uncertainty.degrees_of_freedom, other.uncertainty.degrees_of_freedom);
  return fit;
}

std::vector<Coordinates> moves_to_rivals(const DampedFit& fit, const BlockFit& blocks) {
  std::vector<Coordinates> all;
  for (const Coordinates& rival : fit.rivals) {
    Coordinates moves = rival - coordinates_of(blocks);
    if (blocks.scales().law == FrictionLaw::Coulomb) moves(kSlipDistance) = 0.0;
    all.push_back(moves);
  }
  return all;
}

}  // namespace slipfit::fit
