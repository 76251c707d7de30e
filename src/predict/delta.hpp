#pragma once

// The delta method: what follows from a fitted model, with exact derivatives. docs/formats.md says what the bands mean.

#include <ceres/jet.h>

#include <optional>
#include <string>

#include "slipfit/core/estimate.hpp"
#include "slipfit/fit/fit.hpp"
#include "slipfit/model/motion.hpp"

namespace slipfit::predict {

/// Numbers that know their derivatives with respect to (ln k, ln w_n, zeta, ln dF).
using Jet = ceres::Jet<double, 4>;

struct ModelJets {
  Jet stiffness_N_per_m, omega_rad_per_s, damping_ratio, difference_N;
};

ModelJets jets_of(const ModelEstimate& model);

/// From derivatives to standard errors and 95 % intervals.
class Propagation {
 public:
  explicit Propagation(const ModelEstimate& model);

  [[nodiscard]] double standard_error(const Jet& y) const;
  /// 97.5 % quantile of Student's t
  [[nodiscard]] double quantile() const { return quantile_; }
  /// Positive quantity: the interval is symmetric in its logarithm, which keeps it positive.
  [[nodiscard]] Estimate positive(const Jet& y) const;

 private:
  const ModelEstimate& model_;
  double quantile_ = 0.0;
};

Estimate unknown(std::string reason);

/// Where stick-slip from rest ends. Unknown where zeta cannot be told from 0; at zeta = 0 it has no end, from zeta = 1
/// on there is none.
struct CriticalPoint {
  Estimate lambda, speed_m_per_s;
};
CriticalPoint critical_point(const ModelEstimate& model, const Propagation& propagation);

/// One stick-slip cycle; forces of the spring above F_k.
struct CycleJets {
  Jet slip_s, stick_s, period_s, periodic_displacement_m, force_peak_N, force_trough_N;
};
/// Empty where damped_motion() has no cycle. speed > 0.
std::optional<CycleJets> cycle_jets(const ModelEstimate& model, double speed_m_per_s);

/// The motion by itself: regime and whether there is a cycle. speed > 0.
Motion motion_of(const ModelEstimate& model, double speed_m_per_s);

/// Spacing of the free oscillation inside a slip, an estimate only: V 2 pi / w. docs/model.md section 8
Jet micro_vibration_spacing_m(const ModelJets& model, double speed_m_per_s);

std::string name_of(Regime regime);

}  // namespace slipfit::predict
