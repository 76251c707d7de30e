#include "fit/selection/carried_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fit/problem/solve.hpp"
#include "fit/selection/rise.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {

void carry_over(const BlockFit& from, BlockFit& to) {
  to.start_at(from.parameters.values);
  to.parameters.level = from.parameters.level;
  std::size_t same = 0;
  for (std::size_t i = 0; i < to.size(); ++i) {
    while (same + 1 < from.size() && from.data(same).slip < to.data(i).slip) ++same;
    to.parameters.cycles[i] = from.parameters.cycles[same];
  }
}

double sum_of_squares(const BlockFit& fit) {
  double sum = 0.0;
  for (const double of_cycle : fit.sums_of_squares()) sum += of_cycle;
  return sum;
}

std::size_t residuals_in(const BlockFit& fit) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < fit.size(); ++i) count += fit.data(i).residuals();
  return count;
}

bool has_slips(const BlockFit& fit) {
  for (std::size_t i = 0; i < fit.size(); ++i) {
    if (!std::isfinite(fit.cycle_sum_of_squares(i))) return false;
  }
  return true;
}

BlockFit carried_to(const std::shared_ptr<const CycleSet>& set, const BlockFit& from) {
  BlockFit to(set, from.scales());
  if (to.level() != from.level()) to = to.with_level(from.level(), from.scales());
  carry_over(from, to);
  to.parameters.values(kSensorTime) = from.parameters.values(kSensorTime);
  return with_rise_after(to);
}

BlockFit with_free_time(const BlockFit& fit, FreeTime time) {
  Scales scales = fit.scales();
  scales.free_time = time;
  return fit.with_scales(scales);
}

double gain_on_same_samples(const DampedFit& rich, const DampedFit& poor) {
  BlockFit again = carried_to(rich.blocks.set(), poor.blocks);
  if (!std::isfinite(solve(again, {poor.held, rich.continuous, true}))) return 0.0;
  // What scatters within the bins of the sticks is in neither sum.
  const double independent =
      effective_samples(rich) * static_cast<double>(residuals_in(rich.blocks)) / rich.uncertainty.samples;
  return independent * std::log(sum_of_squares(again) / sum_of_squares(rich.blocks)) - 2.0;
}

}  // namespace slipfit::fit
