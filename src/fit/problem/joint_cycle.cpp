#include "fit/problem/joint_cycle.hpp"

#include <algorithm>
#include <cmath>

namespace slipfit::fit {

SlopeRatio slope_ratio(double a) {
  if (std::abs(a) < 1e-4) return {1.0 - 0.5 * a, -0.5 + a / 6.0};  // a^2 / 12 is left out
  const double growth = std::expm1(a);
  return {a / growth, (growth - a * (growth + 1.0)) / (growth * growth)};
}

std::optional<JointCycle::State> JointCycle::state(const double* shared, const double* own) const {
  const double stiffness = std::exp(shared[kJointStiffness]);
  const double omega = std::exp(shared[kJointFrequency]);
  const double speed = run_->scales.speed_m_per_s;
  const double u = stiffness * speed / omega;
  const double onset_force = run_->scales.force * own[1];
  const double rate = shared[kFrictionRate] * speed / scales_.slip_speed_m_per_s;
  const SlopeRatio ratio = slope_ratio(shared[kFrictionRate]);
  auto track = model::VelocityTrack::solve(onset_force / u, shared[kJointDamping],
                                           2.0 * run_->load * shared[kFrictionSlope] * ratio.value, rate);
  if (!track) return std::nullopt;
  const double onset_s = reference_s_ + run_->scales.half_period_s * own[0];
  return State{omega, u, onset_s, onset_force, onset_force / u, ratio, std::move(*track)};
}

/// Writes residual rows one after the other.
class JointCycle::Rows {
 public:
  Rows(const JointCycle& cycle, const JointValues& values, double* residuals, const JointJacobians& jacobians)
      : cycle_(cycle),
        values_(values),
        residuals_(residuals),
        jacobians_(jacobians),
        drift_columns_(cycle.drift_parameters()),
        own_columns_(cycle.own_parameters()),
        skip_(cycle.level_->terms > 0 ? 1 : 0) {}

  /// `gradient`: d model / d (shared, onset, onset force); `basis`: the level's columns, the constant first;
  /// `constant_share`: 1, but 0 in rows of slopes, which the constant level does not enter.
  void put(double weight, double data, double model, const std::array<double, kJointShared + 2>& gradient,
           const double* basis, double constant_share) {
    const Scales& scales = cycle_.run_->scales;
    for (std::size_t i = 0; i < drift_columns_; ++i) model += scales.force * values_.drift[i] * basis[skip_ + i];
    const double level_unit = cycle_.run_->load * cycle_.scales_.force;
    if (cycle_.level_->per_cycle) {
      model += constant_share * (scales.level + scales.force * values_.own[2]);
    } else {
      model += constant_share * level_unit * *values_.level;
    }
    residuals_[row_] = weight * (data - model);
    if (jacobians_.shared != nullptr) {
      for (std::size_t i = 0; i < kJointShared; ++i) jacobians_.shared[row_ * kJointShared + i] = -weight * gradient[i];
    }
    if (jacobians_.level != nullptr) {
      jacobians_.level[row_] = cycle_.level_->per_cycle ? 0.0 : -weight * constant_share * level_unit;
    }
    if (jacobians_.difference != nullptr) jacobians_.difference[row_] = 0.0;
    if (jacobians_.drift != nullptr) {
      for (std::size_t i = 0; i < drift_columns_; ++i) {
        jacobians_.drift[row_ * drift_columns_ + i] = -weight * scales.force * basis[skip_ + i];
      }
    }
    if (jacobians_.own != nullptr) {
      double* own = jacobians_.own + row_ * own_columns_;
      own[0] = -weight * gradient[kJointShared];
      own[1] = -weight * gradient[kJointShared + 1];
      if (own_columns_ > 2) own[2] = -weight * constant_share * scales.force;
    }
    ++row_;
  }

  /// F_s of this cycle against the population's: A + c V - (F_s - F_k(0+)).
  void tie_static_friction(const State& s) {
    const double weight = 1.0 / cycle_.run_->onset_sd;
    const double zeta = values_.shared[kJointDamping];
    const double drag = 2.0 * zeta * s.force_scale;
    const double unit = cycle_.run_->load * cycle_.scales_.force;
    clear_row();
    residuals_[row_] = weight * (unit * *values_.difference - s.onset_force - drag);
    if (jacobians_.shared != nullptr) {
      double* shared = jacobians_.shared + row_ * kJointShared;
      shared[kJointStiffness] = -weight * drag;
      shared[kJointFrequency] = weight * drag;
      shared[kJointDamping] = -weight * 2.0 * s.force_scale;
    }
    if (jacobians_.difference != nullptr) jacobians_.difference[row_] = weight * unit;
    if (jacobians_.own != nullptr) jacobians_.own[row_ * own_columns_ + 1] = -weight * cycle_.run_->scales.force;
    ++row_;
  }

  void tie_level() {
    const Scales& scales = cycle_.run_->scales;
    const double weight = 1.0 / cycle_.run_->level_sd;
    const double unit = cycle_.run_->load * cycle_.scales_.force;
    clear_row();
    residuals_[row_] = weight * (unit * *values_.level - scales.level - scales.force * values_.own[2]);
    if (jacobians_.level != nullptr) jacobians_.level[row_] = weight * unit;
    if (jacobians_.own != nullptr) jacobians_.own[row_ * own_columns_ + 2] = -weight * scales.force;
    ++row_;
  }

 private:
  void clear_row() const {
    const auto clear = [&](double* matrix, std::size_t columns) {
      if (matrix != nullptr) std::fill_n(matrix + row_ * columns, columns, 0.0);
    };
    clear(jacobians_.shared, kJointShared);
    clear(jacobians_.level, 1);
    clear(jacobians_.difference, 1);
    clear(jacobians_.drift, drift_columns_);
    clear(jacobians_.own, own_columns_);
  }

  const JointCycle& cycle_;
  const JointValues& values_;
  double* residuals_;
  const JointJacobians& jacobians_;
  std::size_t drift_columns_;
  std::size_t own_columns_;
  std::size_t skip_;  // the constant, first of the basis where there is a polynomial
  std::size_t row_ = 0;
};

bool JointCycle::evaluate(const JointValues& values, double* residuals, const JointJacobians& jacobians) const {
  const std::optional<State> s = state(values.shared, values.own);
  if (!s) return false;
  const Scales& scales = run_->scales;
  const double u = s->force_scale;
  const double w = s->omega_rad_per_s;
  const double ramp = u * w;  // k V
  // F = level + u z(tau; z0, zeta, slope, rate), transmitted + 2 zeta u z', tau = w_n (t - onset), z0 = A / u, u = k V
  // / w_n
  const double slope_unit = 2.0 * run_->load * u;
  const double rate_unit = u * scales.speed_m_per_s / scales_.slip_speed_m_per_s;
  const auto gradient_at = [&](const model::TrackPoint& p, double tau) {
    const double scale_part = u * (p.z - s->z0 * p.d_z0);  // d / d ln u at fixed tau
    return std::array<double, kJointShared + 2>{
        scale_part,
        -scale_part + u * p.d_tau * tau,
        u * p.d_zeta,
        slope_unit * s->ratio.value * p.d_slope,
        rate_unit * p.d_rate + slope_unit * values.shared[kFrictionSlope] * s->ratio.derivative * p.d_slope,
        -u * p.d_tau * w * scales.half_period_s,
        scales.force * p.d_z0};
  };
  const auto force_at = [&](double tau) {
    return run_->scales.view == ForceView::Transmitted ? s->track.transmitted_at(tau) : s->track.at(tau);
  };
  Rows rows(*this, values, residuals, jacobians);
  const double* basis = model_->basis().data();
  const std::size_t columns = level_->columns();
  const CycleData& data = model_->data();
  for (std::size_t i = 0; i < data.time_s.size(); ++i, basis += columns) {
    const double tau = w * (data.time_s[i] - s->onset_s);
    const model::TrackPoint p = force_at(tau);
    rows.put(1.0 / run_->noise, data.force[i], u * p.z, gradient_at(p, tau), basis, 1.0);
  }
  for (const auto* bins : {&data.bins_before, &data.bins_after}) {
    for (const StickBin& bin : *bins) {
      const double tau = w * (bin.time_s - s->onset_s);
      const model::TrackPoint p = force_at(tau);
      rows.put(std::sqrt(bin.count) / run_->noise, bin.force, u * p.z, gradient_at(p, tau), basis, 1.0);
      basis += columns;
      rows.put(std::sqrt(bin.time_spread) / run_->noise, bin.slope, ramp, {ramp}, basis, 0.0);
      basis += columns;
    }
  }
  rows.tie_static_friction(*s);
  if (level_->per_cycle) rows.tie_level();
  return true;
}

}  // namespace slipfit::fit
