#include "signal/falls.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "core/slip_thresholds.hpp"
#include "signal/robust.hpp"

namespace slipfit::signal {
namespace {

/// The trace in pieces that stay in the cache: f(place of the first value, values).
template <class F>
void for_each_piece(const Means& trace, const F& f) {
  std::array<double, 512> piece{};
  for (std::size_t first = 0; first < trace.size(); first += piece.size()) {
    const std::span<double> values(piece.data(), std::min(piece.size(), trace.size() - first));
    trace.copy(first, values);
    f(first, values);
  }
}

struct Extent {
  double low = HUGE_VAL;
  double high = -HUGE_VAL;

  void add(std::span<const double> values) {
    const Eigen::Map<const Eigen::ArrayXd> looked_at(values.data(), std::ssize(values));
    low = std::min(low, looked_at.minCoeff());
    high = std::max(high, looked_at.maxCoeff());
  }
  [[nodiscard]] double range() const { return std::max(0.0, high - low); }
};

/// The values processed so far and their turning points.
struct Passed {
  double range = 0.0;
  std::vector<std::size_t> turns;
};

Passed pass(const Means& trace, double hysteresis) {
  Extent extent;
  TurningPoints turns(hysteresis);
  for_each_piece(trace, [&](std::size_t first, std::span<const double> values) {
    extent.add(values);
    turns.add(first, values);
  });
  return {extent.range(), turns.turns()};
}

double range_of(const Means& trace) {
  Extent extent;
  for_each_piece(trace, [&](std::size_t, std::span<const double> values) { extent.add(values); });
  return extent.range();
}

/// A slip in two steps: what rises between is small.
bool is_pause(const SeenFall& first, const SeenFall& second) {
  const double rise = second.peak.value - first.trough.value;
  return rise < thresholds::kPauseRise * std::min(first.drop(), second.drop());
}

/// Falls whose rise between is nearly as quick as they are belong together: the body or the load cell rings. Where the
/// rises that are left are no slower than those, nothing rings: it is a wave. Then the falls as they were.
std::vector<SeenFall> joined(std::vector<SeenFall> falls) {
  constexpr std::size_t kFewest = 3;
  std::vector<SeenFall> result;
  std::vector<double> sticks, rings;
  double before = 0.0;
  for (std::size_t i = 0; i < falls.size(); ++i) {
    const SeenFall& fall = falls[i];
    const double own = rate(fall);
    const double rise = i == 0 ? 0.0 : rate(falls[i - 1].trough, fall.peak);
    const bool rings_on =
        rise > thresholds::kRingingRise * std::max(own, before) || (i > 0 && is_pause(falls[i - 1], fall));
    before = own;
    if (i > 0) (rings_on ? rings : sticks).push_back(rise);
    if (!rings_on) {
      result.push_back(fall);
    } else if (fall.trough.value < result.back().trough.value) {
      result.back().trough = fall.trough;
    }
  }
  const bool is_separable = median(std::move(sticks)) < thresholds::kRingApart * median(std::move(rings));
  return is_separable && result.size() >= kFewest ? result : falls;
}

}  // namespace

double rate(const Turn& from, const Turn& to) {
  return std::abs(to.value - from.value) / static_cast<double>(std::max<std::size_t>(1, to.at - from.at));
}

Falls::Falls(const Means& trace, double noise) {
  const auto smallest_of = [noise](double range) { return std::max(thresholds::kNoiseSigmas * noise, 1e-9 * range); };
  // Where there is no noise the range has to be known beforehand: every rounding error would turn.
  smallest_ = smallest_of(noise > 0.0 ? 0.0 : range_of(trace));
  Passed passed = pass(trace, smallest_);
  if (smallest_of(passed.range) > smallest_) {
    smallest_ = smallest_of(passed.range);
    passed = pass(trace, smallest_);
  }
  range_ = passed.range;
  turns_.reserve(passed.turns.size());
  if (trace.size() == 0) return;
  for (const std::size_t at : passed.turns) turns_.push_back({at, trace[at]});
}

TurningPoints Falls::turning_points(double hysteresis) const {
  TurningPoints turns(hysteresis);
  for (std::size_t i = 0; i < turns_.size(); ++i) turns.add(i, turns_[i].value);
  return turns;
}

bool Falls::coarsen(double hysteresis) {
  const std::size_t before = turns_.size();
  std::vector<Turn> left;
  for (const std::size_t i : turning_points(hysteresis).turns()) left.push_back(turns_[i]);
  turns_ = std::move(left);
  return turns_.size() < before;
}

std::vector<SeenFall> Falls::beyond(double hysteresis) const {
  std::vector<SeenFall> falls;
  const TurningPoints turns = turning_points(hysteresis);
  for (const Fall& fall : turns.falls()) falls.push_back({turns_[fall.peak], turns_[fall.trough]});
  return joined(std::move(falls));
}

}  // namespace slipfit::signal
