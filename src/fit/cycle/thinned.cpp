#include <algorithm>
#include <cmath>

#include "fit/cycle/cycle_data.hpp"

namespace slipfit::fit {

CycleData thinned(CycleData cycle, double middle_s, double half_period_s, double step_s) {
  constexpr double kSamples = 20.0;
  constexpr double kReach = 2.0;
  constexpr std::size_t kSmooth = 4;
  const auto stride = static_cast<std::size_t>(std::max(1.0, half_period_s / step_s / kSamples));
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < cycle.time_s.size(); ++i) {  // by their numbers: steps stay even where some are left out
    const bool is_near = std::abs(cycle.time_s[i] - middle_s) <= kReach * half_period_s;
    const std::size_t every = is_near ? stride : kSmooth * stride;
    if ((cycle.samples[i] - cycle.samples.front()) % every == 0) kept.push_back(i);
  }
  const auto thin = [&](auto& values) {
    if (values.empty()) return;
    for (std::size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
    values.resize(kept.size());
  };
  thin(cycle.samples);
  thin(cycle.time_s);
  thin(cycle.force);
  thin(cycle.weight);
  return cycle;
}

std::vector<CycleData> spread_subset(const std::vector<CycleData>& cycles, std::size_t size) {
  if (cycles.size() <= size) return cycles;
  std::vector<CycleData> subset;
  for (std::size_t i = 0; i < size; ++i) subset.push_back(cycles[i * (cycles.size() - 1) / (size - 1)]);
  return subset;
}

}  // namespace slipfit::fit
