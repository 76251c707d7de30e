#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "fit/level/reloading.hpp"

namespace slipfit::fit {

/// Describes the kinetic level F_k by one polynomial in time (additive drift of the sensor, order 0: constant) or by
/// one value a cycle (friction that wanders). It also describes hum of the mains by a cosine and a sine for each line,
/// and a rise of the force after slips.
struct LevelModel {
  bool per_cycle = false;
  std::size_t terms = 1;  ///< of the Legendre polynomial; 0 where per_cycle
  std::vector<double> lines_Hz;
  std::shared_ptr<const RiseAfterSlip> reloading{};  ///< null: sticks are straight

  friend bool operator==(const LevelModel&, const LevelModel&) = default;

  /// Functions of time with a coefficient each: those of the polynomial, then cosine and sine of each line.
  [[nodiscard]] std::size_t columns() const { return terms + 2 * lines_Hz.size(); }
  [[nodiscard]] std::size_t columns_behind_constant() const { return columns() - (terms > 0 ? 1 : 0); }
};

}  // namespace slipfit::fit
