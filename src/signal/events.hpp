#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace slipfit::signal {

/// A fall between two turning points.
struct Fall {
  std::size_t peak = 0;
  std::size_t trough = 0;
};

/// Falls of at least `hysteresis`, each bounded by rises of at least as much (or by the ends of the trace). Noise
/// smaller than the hysteresis makes no turning point, however often it crosses a level. Values come in their order,
/// one by one or several.
class TurningPoints {
 public:
  explicit TurningPoints(double hysteresis) : hysteresis_(hysteresis) {}

  void add(std::size_t i, double value) {
    if (falling_) {
      if (value < lowest_) {
        lowest_ = value;
        low_ = i;
      } else if (value > lowest_ + hysteresis_) {
        falls_.push_back({high_, low_});
        falling_ = false;
        highest_ = value;
        high_ = i;
      }
    } else if (value > highest_) {
      highest_ = value;
      high_ = i;
    } else if (value < highest_ - hysteresis_) {
      falling_ = true;
      lowest_ = value;
      low_ = i;
    }
  }

  /// The values `first`, `first` + 1, ...: as each alone, but most are passed over several at once.
  void add(std::size_t first, std::span<const double> values);

  [[nodiscard]] const std::vector<Fall>& falls() const { return falls_; }

  /// Peaks and troughs in turn, including undecided ones at the end: all that a larger hysteresis can turn at.
  [[nodiscard]] std::vector<std::size_t> turns() const {
    std::vector<std::size_t> turns;
    turns.reserve(2 * falls_.size() + 2);
    for (const Fall& fall : falls_) turns.insert(turns.end(), {fall.peak, fall.trough});
    turns.push_back(high_);
    if (falling_) turns.push_back(low_);
    return turns;
  }

 private:
  double hysteresis_;
  std::vector<Fall> falls_;
  std::size_t high_ = 0;
  std::size_t low_ = 0;
  double highest_ = -std::numeric_limits<double>::infinity();
  double lowest_ = 0.0;
  bool falling_ = false;
};

/// Falls of one trace at the time scale that shows them best.
struct Events {
  std::vector<Fall> falls;    ///< samples of `trace`; at least a quarter of the median fall
  std::vector<double> trace;  ///< the force at this scale, one value a sample
  std::size_t width = 1;      ///< samples that it was smoothed over
  std::size_t minor = 0;      ///< smaller falls
  double noise = 0.0;         ///< standard deviation that is left at this scale
  double hysteresis = 0.0;    ///< swing that makes a turning point
};

/// Sudden falls after slow rises, whatever follows them: the trace is smoothed over widths in equal ratios, its turning
/// points are taken with hystereses in equal ratios, falls are joined where the rise between them is as quick as they
/// are (ringing). The scale whose falls exceed its noise most often and are most sudden is chosen, at the finest scale
/// that shows the same falls. `noise`: of the samples. `width`: in samples, where the scale is known.
Events find_events(std::vector<double> force, double noise, std::optional<std::size_t> width = std::nullopt);

}  // namespace slipfit::signal
