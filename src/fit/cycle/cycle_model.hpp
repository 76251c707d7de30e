#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "fit/cycle/cycle_data.hpp"
#include "fit/cycle/sensor_lag.hpp"
#include "model/slip.hpp"

namespace slipfit::fit {

/// Values of the Legendre polynomials P_0 ... P_(terms-1) at x, and their derivatives.
void legendre(double x, std::size_t terms, double* values, double* derivatives);

/// Shared by all cycles: ln k, ln w_n, zeta. zeta may be negative while fitting (any |zeta| < 1), so that its estimate
/// is not pushed away from 0; the interval is cut there afterwards.
inline constexpr std::size_t kShared = 3;
using Shared = std::array<double, kShared>;

/// How the kinetic level F_k is described: one polynomial in time (additive drift of the sensor, order 0: constant) or
/// one value a cycle (friction that wanders); beside it hum of the mains, a cosine and a sine for each line.
struct LevelModel {
  bool per_cycle = false;
  std::size_t terms = 1;  ///< of the Legendre polynomial; 0 where per_cycle
  std::vector<double> lines_Hz;

  /// Shared coefficients: polynomial first, then cosine and sine of each line.
  [[nodiscard]] std::size_t columns() const { return terms + 2 * lines_Hz.size(); }
};

/// A cycle's own numbers, scaled: onset time (from the detected middle, in half periods), force at onset above the
/// level and, where the level is per cycle, the level. The last is 0 and unused otherwise.
using Own = std::array<double, 3>;

struct Parameters {
  Shared shared{};
  std::vector<double> level;  ///< LevelModel::columns() coefficients, scaled by Scales::force
  std::vector<Own> cycles;
};

/// What the physical numbers are for one cycle.
struct CycleState {
  double stiffness_N_per_m = 0.0;
  double omega_rad_per_s = 0.0;
  double zeta = 0.0;
  double force_scale = 0.0;  ///< u = k V / w_n
  double onset_s = 0.0;
  double onset_force = 0.0;  ///< above the level, A
  model::Slip slip;
  model::StickLine after;
  double lag_tau = 0.0;  ///< of the sensor, w_n T
};

/// The residuals of one cycle: (data - model) / noise for every sample around the slip, and two for each stick bin
/// (its mean and its slope, weighted as the samples in it).
class CycleModel {
 public:
  CycleModel(const CycleData& data, const Scales& scales, double reference_s, LevelModel level);

  [[nodiscard]] std::size_t residuals() const { return data_->residuals(); }
  [[nodiscard]] std::size_t own_parameters() const { return level_.per_cycle ? 3 : 2; }
  [[nodiscard]] std::size_t level_parameters() const { return level_.columns(); }
  /// Columns of the Jacobian: shared, level, own.
  [[nodiscard]] std::size_t columns() const { return kShared + level_parameters() + own_parameters(); }
  [[nodiscard]] const CycleData& data() const { return *data_; }
  /// The level's columns at every residual row, the constant first; of slope rows their slopes.
  [[nodiscard]] const std::vector<double>& basis() const { return basis_; }

  /// Residuals and, unless null, their Jacobian (residuals() x columns(), column after column). Empty slip (lambda <=
  /// 0) has no solution: false, outputs untouched.
  bool evaluate(const double* shared, const double* level, const double* own, double* residuals,
                double* jacobian) const;

  bool state(const double* shared, const double* own, CycleState& state) const;
  /// Without hum.
  [[nodiscard]] double level_at(double time_s, const double* level, const double* own) const;
  [[nodiscard]] double hum_at(double time_s, const double* level) const;
  /// Model force at any time of the cycle, without hum.
  [[nodiscard]] double force_at(const CycleState& state, double time_s, const double* level, const double* own) const;
  /// Of the straight sticks before and after the slip: their force above the level, led back to the onset. It rises
  /// with k V.
  [[nodiscard]] std::array<double, 2> stick_forces(const CycleState& state) const {
    return {state.force_scale * stick_before(state, 0.0).z, state.force_scale * stick_after(state, 0.0).z};
  }

 private:
  /// Force above the level in units of u, as the sensor sees it.
  [[nodiscard]] model::WavePoint wave_at(const CycleState& state, double tau) const;
  /// In the slip, from exp(-zeta tau) cos b tau and exp(-zeta tau) sin b tau.
  [[nodiscard]] model::WavePoint slip_at(const CycleState& state, double tau, double c, double bs) const;
  [[nodiscard]] model::WavePoint stick_before(const CycleState& state, double tau) const;
  [[nodiscard]] model::WavePoint stick_after(const CycleState& state, double tau) const;
  [[nodiscard]] model::WavePoint as_shown(const CycleState& state, model::WavePoint stick) const;
  void fill_basis();

  const CycleData* data_;
  Scales scales_;
  double reference_s_;
  LevelModel level_;
  double even_step_s_ = 0.0;   ///< between the samples around the slip; 0 where they are not evenly spaced
  std::vector<double> basis_;  ///< level_.columns() values for every residual row (slopes for slope rows)
};

// Inline: asked for every sample of the recording.

inline double CycleModel::level_at(double time_s, const double* level, const double* own) const {
  if (level_.per_cycle) return scales_.level + scales_.force * own[2];
  if (level_.terms == 1) return scales_.level + scales_.force * level[0];
  const double x = 2.0 * (time_s - scales_.time_begin_s) / (scales_.time_end_s - scales_.time_begin_s) - 1.0;
  // Legendre polynomials by their recurrence
  double sum = 0.0;
  double value = 1.0;
  double before = 0.0;
  for (std::size_t n = 0; n < level_.terms; ++n) {
    sum += level[n] * value;
    const auto order = static_cast<double>(n);
    const double next = ((2.0 * order + 1.0) * x * value - order * before) / (order + 1.0);
    before = value;
    value = next;
  }
  return scales_.level + scales_.force * sum;
}

inline double CycleModel::hum_at(double time_s, const double* level) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < level_.lines_Hz.size(); ++i) {
    const double phase = 2.0 * std::numbers::pi * level_.lines_Hz[i] * (time_s - scales_.time_begin_s);
    const double* pair = level + level_.terms + 2 * i;
    sum += pair[0] * std::cos(phase) + pair[1] * std::sin(phase);
  }
  return scales_.force * sum;
}

inline double CycleModel::force_at(const CycleState& state, double time_s, const double* level,
                                   const double* own) const {
  const double tau = state.omega_rad_per_s * (time_s - state.onset_s);
  return level_at(time_s, level, own) + state.force_scale * wave_at(state, tau).z;
}

inline model::WavePoint CycleModel::wave_at(const CycleState& state, double tau) const {
  const bool transmitted = scales_.view == ForceView::Transmitted;
  if (state.lag_tau > 0.0) return SensorLag{state.lag_tau, transmitted}.wave_at(state.slip, tau);
  if (tau > 0.0 && tau <= state.slip.tau_end) {
    const double decay = std::exp(-state.zeta * tau);
    return slip_at(state, tau, decay * std::cos(state.slip.b * tau), decay * std::sin(state.slip.b * tau));
  }
  return tau <= 0.0 ? stick_before(state, tau) : stick_after(state, tau);
}

inline model::WavePoint CycleModel::slip_at(const CycleState& state, double tau, double c, double bs) const {
  const double s = bs / state.slip.b;
  return scales_.view == ForceView::Transmitted ? model::transmitted_wave(state.slip, tau, c, s)
                                                : model::slip_wave(state.slip, tau, c, s);
}

inline model::WavePoint CycleModel::stick_before(const CycleState& state, double tau) const {
  return as_shown(state, {state.slip.z0 + tau, 1.0, 0.0, 1.0});
}

inline model::WavePoint CycleModel::stick_after(const CycleState& state, double tau) const {
  return as_shown(state, {state.after.intercept + tau, state.after.d_z0, state.after.d_zeta, 1.0});
}

/// A straight ramp lags by T, and so by kV T.
inline model::WavePoint CycleModel::as_shown(const CycleState& state, model::WavePoint stick) const {
  if (scales_.view == ForceView::Transmitted) {
    stick.z += 2.0 * state.zeta;
    stick.d_zeta += 2.0;
  }
  stick.z -= state.lag_tau;
  stick.d_log_omega -= state.lag_tau;
  return stick;
}

}  // namespace slipfit::fit
