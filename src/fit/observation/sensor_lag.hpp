#pragma once

#include "model/slip.hpp"

namespace slipfit::fit {

/// What a sensor of first order shows of one cycle, T F' + F = force, in the scaled units of model/slip.hpp:
/// y' + kappa y = kappa z with kappa = 1 / (w_n T). docs/model.md section 7
struct SensorLag {
  double lag_tau = 0.0;  ///< w_n T = 1 / kappa
  bool transmitted = false;

  /// At any tau; the stick before the slip counts as long enough for the slip before it to be forgotten.
  [[nodiscard]] model::WavePoint wave_at(const model::Slip& slip, double tau) const;
};

}  // namespace slipfit::fit
