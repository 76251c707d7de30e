#pragma once

#include <cstddef>
#include <vector>

#include "fit/cycle/cycle_data.hpp"

namespace slipfit::fit {

/// Reloading hysteresis: after a slip the force rises by A (1 - exp(-x / l)) more than by k x over the path x = V t of
/// the stick (docs/model.md section 10). Columns of the level: one counts A; where l is free a second one counts A
/// times what ln l is off by, to first order. The ends of the slips stand still while fitting.
struct RiseAfterSlip {
  double length_m = 0.0;  ///< l
  bool is_free = false;   ///< l
  double speed_m_per_s = 0.0;
  double average_s = 0.0;            ///< of the sensor
  std::vector<double> slip_begin_s;  ///< of every slip of the recording
  std::vector<double> slip_end_s;

  [[nodiscard]] std::size_t columns() const { return is_free ? 2 : 1; }

  /// A share of A and its derivative with respect to ln l.
  struct Share {
    double value = 0.0;
    double by_log_length = 0.0;
  };
  /// What its columns add up to with these coefficients.
  [[nodiscard]] double sum_of(const Share& share, const double* coefficients) const {
    return coefficients[0] * share.value + (is_free ? coefficients[1] * share.by_log_length : 0.0);
  }
  /// Near this slip: what the rise after the slip before it still lacks at the onset (below 0), 0 in the slip, the rise
  /// after it.
  [[nodiscard]] Share at(std::size_t slip, double time_s) const;

  /// Mean and least-squares slope over a bin's samples, evenly spread.
  struct Line {
    Share mean, slope;
  };
  [[nodiscard]] Line over(std::size_t slip, const StickBin& bin) const;
};

}  // namespace slipfit::fit
