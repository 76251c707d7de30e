#include "fit/rough_misfit.hpp"

#include <cmath>

#include "fit/inference/uncertainty.hpp"
#include "fit/selection/damped_fit.hpp"

namespace slipfit::fit {

std::optional<RoughMisfit> rough_misfit(const FitInput& few) {
  const std::optional<BlockFit> fit = rough_fit(few);
  if (!fit) return std::nullopt;
  const auto cycles = static_cast<double>(fit->size());
  double mean = 0.0;
  for (const Local& local : fit->parameters.cycles) mean += local[1] / cycles;
  double square = 0.0;
  for (const Local& local : fit->parameters.cycles) square += std::pow(local[1] - mean, 2);
  const Scales& scales = fit->scales();
  return RoughMisfit{scales.noise * std::sqrt(reduced_chi2(*fit)) / std::abs(scales.force * mean),
                     std::sqrt(square / (cycles - 1.0)) / std::abs(mean), fit->size()};
}

}  // namespace slipfit::fit
