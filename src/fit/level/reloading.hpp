#pragma once

#include <cstddef>
#include <vector>

#include "fit/cycle/cycle_data.hpp"

namespace slipfit::fit {

/// Reloading hysteresis: after a slip the force rises by A (1 - exp(-x / l)) more than by k x over the path x = V t of
/// the stick (docs/model.md section 10). The ends of the slips are fixed while fitting.
struct RiseAfterSlip {
  double length_m = 0.0;  ///< l with which a fit begins
  /// The fit ends with this l at most: over a longer path the rise cannot be distinguished from a softer spring.
  double longest_m = 0.0;
  bool is_free = false;  ///< the fit solves for l
  double speed_m_per_s = 0.0;
  std::vector<double> slip_begin_s;  ///< of every slip of the recording
  std::vector<double> slip_end_s;

  /// Holds what the share of A depends on.
  struct Shape {
    double length_m = 0.0;
    double average_s = 0.0;  ///< over which the sensor averages; 0: it does not
  };
  /// A share of A and its derivatives with respect to ln l and to the logarithm of the average.
  struct Share {
    double value = 0.0;
    double by_log_length = 0.0;
    double by_log_average = 0.0;
  };
  /// Near this slip: what the rise after the slip before it still lacks at the onset (below 0), 0 in the slip, the rise
  /// after it.
  [[nodiscard]] Share at(std::size_t slip, double time_s, const Shape& shape) const;

  /// Holds mean and least-squares slope over a bin's samples, evenly spread.
  struct Line {
    Share mean, slope;
  };
  [[nodiscard]] Line over(std::size_t slip, const StickBin& bin, const Shape& shape) const;

 private:
  [[nodiscard]] Share without_average(std::size_t slip, double time_s, double over_m) const;
};

}  // namespace slipfit::fit
