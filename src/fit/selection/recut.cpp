#include "fit/selection/recut.hpp"

#include <algorithm>
#include <utility>

#include "fit/level/add_hum.hpp"
#include "fit/level/mains_hum.hpp"
#include "fit/selection/first_guess.hpp"

namespace slipfit::fit {
namespace {

std::vector<CycleData> cycles_of(const Cut& cut, const HumLines& hum) {
  return cut_cycles(cut.recording, cut.segmentation, cut.half_width_s, cut.excluded, hum);
}

}  // namespace

std::vector<CycleData> same_cycles_of(const BlockFit& fit, std::vector<CycleData> cut) {
  std::vector<CycleData> same;
  std::size_t next = 0;
  for (CycleData& cycle : cut) {
    while (next < fit.size() && fit.data(next).slip < cycle.slip) ++next;
    if (next == fit.size() || fit.data(next).slip != cycle.slip) continue;
    cycle.continuous_with_next = fit.data(next).continuous_with_next;
    same.push_back(std::move(cycle));
  }
  return same;
}

std::optional<BlockFit> recut(BlockFit fit, const Cut& cut, const std::vector<std::size_t>& bad,
                              const std::vector<double>& lines_Hz) {
  const std::vector<double> hum_start = hum_at_other_frequencies(fit, lines_Hz);
  const Parameters start = std::move(fit.parameters);
  const Scales scales = fit.scales();
  LevelModel level = fit.level();
  std::vector<std::size_t> slips;
  for (std::size_t i = 0; i < fit.size(); ++i) slips.push_back(fit.data(i).slip);
  { const BlockFit released = std::move(fit); }
  std::vector<CycleData> kept;
  for (CycleData& cycle : cycles_of(cut, {lines_Hz, scales.time_begin_s})) {
    if (std::find(bad.begin(), bad.end(), cycle.slip) == bad.end()) {
      kept.push_back(std::move(cycle));
    } else if (!kept.empty()) {
      kept.back().continuous_with_next = false;
    }
  }
  level.lines_Hz = lines_Hz;
  std::vector<double> middles = middles_s(cut.segmentation, kept);
  std::optional<BlockFit> anew = BlockFit::create(std::move(kept), std::move(middles), scales, level);
  if (!anew) return std::nullopt;
  Parameters& parameters = anew->parameters;
  parameters.values = start.values;
  const auto before_lines = static_cast<std::ptrdiff_t>(level.terms);
  std::copy_n(start.level.begin(), before_lines, parameters.level.begin());
  std::copy(hum_start.begin(), hum_start.end(), parameters.level.begin() + before_lines);
  std::size_t old = 0;
  for (std::size_t i = 0; i < anew->size(); ++i) {
    while (old + 1 < slips.size() && slips[old] < anew->data(i).slip) ++old;  // a last slip may be new
    parameters.cycles[i] = start.cycles[old];
  }
  return anew;
}

BlockFit with_hum_in_bins(BlockFit fit, const Cut& cut) {
  std::vector<CycleData> cycles = same_cycles_of(fit, cycles_of(cut, hum_of(cut.recording, fit)));
  std::vector<double> middles = middles_s(cut.segmentation, cycles);
  std::optional<BlockFit> same = BlockFit::create(std::move(cycles), std::move(middles), fit.scales(), fit.level());
  if (!same || same->size() != fit.size()) return fit;
  same->parameters = std::move(fit.parameters);
  return *std::move(same);
}

}  // namespace slipfit::fit
