#include "fit/selection/carried_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fit/problem/solve.hpp"
#include "fit/problem/solve_options.hpp"
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

std::size_t residuals_in(const BlockFit& fit) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < fit.size(); ++i) count += fit.data(i).residuals();
  return count;
}

namespace {

/// Returns the sum of squares that the solver finds the least of.
double robust_sum(const BlockFit& fit) {
  const std::vector<double> sums = fit.sums_of_squares();
  double sum = 0.0;
  for (std::size_t i = 0; i < sums.size(); ++i) sum += huber_weight(std::sqrt(sums[i]), fit.data(i).residuals()).sum;
  return sum;
}

}  // namespace

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
  const double sum = solve(again, {poor.held, rich.continuous, true});
  if (!std::isfinite(sum)) return 0.0;
  // What scatters within the bins of the sticks is in neither sum.
  const double independent =
      effective_samples(rich) * static_cast<double>(residuals_in(rich.blocks)) / rich.uncertainty.samples;
  return independent * std::log(sum / robust_sum(rich.blocks)) - 2.0;
}

}  // namespace slipfit::fit
