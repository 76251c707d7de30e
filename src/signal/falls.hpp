#pragma once

#include <cstddef>
#include <vector>

#include "signal/smoothing.hpp"
#include "signal/turning_points.hpp"

namespace slipfit::signal {

/// A turning point of a trace.
struct Turn {
  std::size_t at = 0;  ///< place in the trace
  double value = 0.0;
};

/// A fall from one turning point to the next.
struct SeenFall {
  Turn peak;
  Turn trough;

  [[nodiscard]] double drop() const { return peak.value - trough.value; }
};

/// Size of the change a place between two turning points, the second behind the first.
double rate(const Turn& from, const Turn& to);

/// Rate of the fall itself.
inline double rate(const SeenFall& fall) {
  return rate(fall.peak, fall.trough);
}

/// The falls of one trace at hystereses that grow: each pass goes over the turning points of the one before.
class Falls {
 public:
  /// The falls that exceed noise of this standard deviation.
  Falls(const Means& trace, double noise);

  /// Highest less lowest value of the trace.
  [[nodiscard]] double range() const { return range_; }
  /// The hysteresis that they were found with: noise makes no turning point of 8 standard deviations; rounding errors
  /// are no motion.
  [[nodiscard]] double smallest() const { return smallest_; }

  /// Increases the hysteresis; returns false if no turning point is too small, so that the falls are unchanged.
  bool coarsen(double hysteresis);

  /// Returns the falls larger than a hysteresis in their order; ringing is joined.
  [[nodiscard]] std::vector<SeenFall> beyond(double hysteresis) const;

 private:
  [[nodiscard]] TurningPoints turning_points(double hysteresis) const;

  double range_ = 0.0;
  double smallest_ = 0.0;
  std::vector<Turn> turns_;
};

}  // namespace slipfit::signal
