#pragma once

#include "model/slip.hpp"

namespace slipfit::fit {

/// What the instrument shows of one cycle, in the scaled units of model/slip.hpp. docs/model.md section 7
/// - a lag of first order, T F' + F = force: y' + kappa y = kappa z with kappa = 1 / (w_n T);
/// - a moving average over w_n W around the time stamp. All its integrals are in closed form.
struct Sensor {
  double lag_tau = 0.0;      ///< w_n T; 0: none
  double average_tau = 0.0;  ///< w_n W; 0: none
  bool transmitted = false;

  /// It shows something else than the force at the time stamp.
  [[nodiscard]] bool smooths() const { return lag_tau > 0.0 || average_tau > 0.0; }
  /// At any tau; the stick before the slip counts as long enough for the slip before it to be forgotten.
  [[nodiscard]] model::WavePoint wave_at(const model::Slip& slip, double tau) const;
};

}  // namespace slipfit::fit
