#include "fit/contact/contact_cycles.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/line_sums.hpp"

namespace slipfit::fit {
namespace {

/// The smaller of the two falls of a slip, over the whole swing: below it noise might be taken for an edge.
constexpr double kSmallestFall = 0.1;
constexpr double kHidingSteps = 1.5;  // a longer step leaves the time of the edge unknown

class Finder {
 public:
  Finder(const Recording& recording, const Segmentation& segmentation)
      : time_s_(recording.time_s()), force_(recording.force()), slips_(segmentation.slips) {
    found_.step_s = recording.sample_interval_s();
  }

  std::optional<ContactCycles> find() {
    for (std::size_t i = 0; i < slips_.size(); ++i) {
      if (const auto edges = find_edges(i)) {
        found_.cycles.push_back(*edges);
      } else if (i > 0 && i + 1 < slips_.size()) {
        ++found_.without_edges;
      }
    }
    if (found_.cycles.size() < 3) return std::nullopt;
    fit_ramps();
    measure_jumps();
    if (found_.cycles.size() < 3) return std::nullopt;
    return found_;
  }

 private:
  /// Finds the two largest falls from one sample to the next, with the plateau between them.
  [[nodiscard]] std::optional<ContactCycle> find_edges(std::size_t slip) const {
    const DetectedSlip& swing = slips_[slip];
    // The smoothed turning points may lie a sample off the edge.
    const std::size_t begin = swing.peak > 0 ? swing.peak - 1 : 0;
    const std::size_t stop = std::min(swing.trough + 1, force_.size() - 1);
    std::size_t first = begin;
    std::size_t second = begin;
    double first_fall = 0.0;
    double second_fall = 0.0;
    for (std::size_t i = begin; i < stop; ++i) {
      const double fall = force_[i] - force_[i + 1];
      if (fall > first_fall) {
        second = first;
        second_fall = first_fall;
        first = i;
        first_fall = fall;
      } else if (fall > second_fall) {
        second = i;
        second_fall = fall;
      }
    }
    if (!(second_fall > kSmallestFall * swing.drop())) return std::nullopt;
    ContactCycle cycle;
    cycle.slip = slip;
    cycle.onset = std::min(first, second);
    cycle.end = std::max(first, second);
    const auto is_short = [&](std::size_t i) { return time_s_[i + 1] - time_s_[i] < kHidingSteps * found_.step_s; };
    if (cycle.end <= cycle.onset || !is_short(cycle.onset) || !is_short(cycle.end)) return std::nullopt;
    cycle.onset_s = 0.5 * (time_s_[cycle.onset] + time_s_[cycle.onset + 1]);
    cycle.end_s = 0.5 * (time_s_[cycle.end] + time_s_[cycle.end + 1]);
    cycle.plateau = reduce(cycle.onset + 1, cycle.end + 1).mean_y;
    return cycle;
  }

  /// Force over time in the samples [begin, end).
  [[nodiscard]] LineSums reduce(std::size_t begin, std::size_t end) const {
    return line_sums(
        end - begin, [&](std::size_t i) { return time_s_[begin + i]; },
        [&](std::size_t i) { return force_[begin + i]; });
  }

  /// Samples of the ramp between two neighbouring slips; empty (end <= begin) where there is none.
  [[nodiscard]] LineSums ramp_after(std::size_t i) const {
    const ContactCycle& before = found_.cycles[i];
    const ContactCycle& after = found_.cycles[i + 1];
    if (after.slip != before.slip + 1 || after.onset + 1 < before.end + 3) return {};
    return reduce(before.end + 1, after.onset + 1);
  }

  /// One slope for all ramps; what the plateaus drift by is taken off (a level that moves bends every ramp by it).
  void fit_ramps() {
    double spread = 0.0, cross = 0.0, rest = 0.0, freedom = -1.0;
    for (std::size_t i = 0; i < found_.cycles.size(); ++i) {
      ramps_.push_back(i + 1 < found_.cycles.size() ? ramp_after(i) : LineSums{});
      spread += ramps_.back().square;
      cross += ramps_.back().cross;
    }
    if (!(spread > 0.0)) return;
    const double slope = cross / spread;
    for (const LineSums& ramp : ramps_) {
      if (ramp.count == 0.0) continue;
      rest += ramp.scatter - 2.0 * slope * ramp.cross + slope * slope * ramp.square;
      freedom += ramp.count - 1.0;
    }
    for (const ContactCycle& cycle : found_.cycles) {
      const LineSums plateau = reduce(cycle.onset + 1, cycle.end + 1);
      rest += plateau.scatter;
      freedom += plateau.count - 1.0;
    }
    const LineSums level = level_of_plateaus();
    const double drift = level.square > 0.0 ? level.slope() : 0.0;
    const double level_rest = std::max(0.0, level.scatter - drift * level.cross);
    const double drift_error2 = level_rest / std::max(1.0, level.count - 2.0) / level.square;
    found_.noise = std::sqrt(std::max(0.0, rest / std::max(1.0, freedom)));
    // A drift within its error is none: taking it off would only add its noise.
    const bool drifts = drift * drift > 9.0 * drift_error2;
    ramp_slope_ = slope;
    found_.drift = drifts ? drift : 0.0;
    found_.slope = slope - found_.drift;
    found_.slope_error = std::sqrt(found_.noise * found_.noise / spread + (drifts ? drift_error2 : 0.0));
  }

  /// Plateau means as points of a line.
  [[nodiscard]] LineSums level_of_plateaus() const {
    return line_sums(
        found_.cycles.size(), [&](std::size_t i) { return found_.cycles[i].onset_s; },
        [&](std::size_t i) { return found_.cycles[i].plateau; });
  }

  /// Jumps against the ramps on either side; cycles without both ramps are dropped.
  void measure_jumps() {
    std::vector<ContactCycle> kept;
    for (std::size_t i = 1; i + 1 < found_.cycles.size(); ++i) {
      ContactCycle cycle = found_.cycles[i];
      const LineSums& before = ramps_[i - 1];
      const LineSums& after = ramps_[i];
      if (before.count == 0.0 || after.count == 0.0) continue;
      const double moved = 0.5 * found_.drift * (cycle.end_s - cycle.onset_s);  // of the level, in half a plateau
      cycle.onset_jump = before.mean_y + ramp_slope_ * (cycle.onset_s - before.mean_x) - cycle.plateau + moved;
      cycle.end_jump = cycle.plateau + moved - after.mean_y - ramp_slope_ * (cycle.end_s - after.mean_x);
      kept.push_back(cycle);
    }
    found_.cycles = std::move(kept);
  }

  std::span<const double> time_s_;
  std::span<const double> force_;
  const std::vector<DetectedSlip>& slips_;
  ContactCycles found_;
  std::vector<LineSums> ramps_;  // after each cycle
  double ramp_slope_ = 0.0;      // of the ramps as measured, drift included
};

}  // namespace

std::optional<ContactCycles> find_contact_cycles(const Recording& recording, const Segmentation& segmentation) {
  return Finder(recording, segmentation).find();
}

}  // namespace slipfit::fit
