#include "fit/cycle/cycle_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fit/law/speed_dependent.hpp"

namespace slipfit::fit {

CycleModel::CycleModel(const CycleSet& set, std::size_t cycle, const Scales& scales)
    : data_(&set.cycles[cycle]),
      level_(&set.level),
      basis_(&set.basis[cycle]),
      scales_(scales),
      reference_s_(set.reference_s[cycle]),
      even_step_s_(set.even_step_s[cycle]) {}

Globals CycleModel::globals_at_speed(const double* globals, double exponent) const {
  Globals own{};
  std::copy_n(globals, this->globals(), own.begin());
  if (!has_exponent()) return own;
  own[kLogStiffness] += exponent * *scales_.population->log_speed;
  own[kLogFrequency] += 0.5 * exponent * *scales_.population->log_speed;
  return own;
}

CycleFrame CycleModel::frame(const double* globals, const double* local) const {
  CycleFrame frame;
  frame.stiffness_N_per_m = std::exp(globals[kLogStiffness]);
  frame.omega_rad_per_s = std::exp(globals[kLogFrequency]);
  frame.zeta = globals[kDamping];
  frame.force_scale = frame.stiffness_N_per_m * scales_.speed_m_per_s / frame.omega_rad_per_s;
  frame.onset_s = reference_s_ + scales_.half_period_s * local[0];
  frame.onset_force = scales_.force * local[1];
  return frame;
}

Globals CycleModel::globals_at_speed(const CycleValues& values) const {
  return globals_at_speed(values.globals, has_exponent() ? *values.exponent : 0.0);
}

double CycleModel::rise_at(double time_s, const double* level) const {
  if (!level_->reloading) return 0.0;
  const double* const rise = level + (has_constant() ? 1 : 0) + level_->first_rise();
  return scales_.force * level_->reloading->sum_of(level_->reloading->at(data_->slip, time_s), rise);
}

std::optional<CycleState> CycleModel::state(const double* globals, const double* local) const {
  const CycleFrame f = frame(globals, local);
  if (scales_.law == FrictionLaw::Weakening) {
    auto motion = WeakeningCycle::solve(f.z0(), f.omega_rad_per_s, globals, scales_);
    return motion ? std::optional(CycleState{f, *std::move(motion)}) : std::nullopt;
  }
  if (!(f.z0() + 2.0 * f.zeta > 0.0) || !(std::abs(f.zeta) < 1.0) || !std::isfinite(f.z0())) return std::nullopt;
  const double w = f.omega_rad_per_s;
  const bool transmitted = scales_.view == ForceView::Transmitted;
  const Sensor sensor{w * scales_.sensor_lag_s, w * scales_.sensor_average_s, transmitted};
  return CycleState{f, CoulombCycle(f.z0(), f.zeta, sensor)};
}

/// Writes residual rows one after the other, and their derivatives column after column. It holds copies of what every
/// row needs: a value behind a reference would have to be read again after each one that is written.
class CycleModel::Rows {
 public:
  Rows(const CycleModel& cycle, const CycleValues& values, double* residuals, double* jacobian)
      : values_(values),
        residuals_(residuals),
        jacobian_(jacobian),
        basis_(cycle.basis_->data() + (cycle.level_->terms > 0 ? 1 : 0)),
        columns_(cycle.level_->columns()),
        stride_(static_cast<std::ptrdiff_t>(cycle.residuals())),
        scales_(cycle.scales_),
        force_(scales_.force),
        level_unit_(scales_.level_unit()),
        drifts_(cycle.drift_parameters()),
        log_speed_(cycle.has_exponent() ? *scales_.population->log_speed : 0.0),
        has_exponent_(cycle.has_exponent()),
        has_difference_(cycle.has_difference()),
        level_per_cycle_(cycle.level_->per_cycle),
        has_constant_(cycle.has_constant()),
        constant_(level_per_cycle_ ? scales_.level + force_ * values.local[2]
                                   : scales_.level_zero() + level_unit_ * *values.constant) {}

  /// `model`: force above the level; `by_global`, `by_onset`, `by_onset_force`: its derivatives. `constant_share`: 1,
  /// but 0 in rows of slopes, which no constant enters.
  template <std::size_t N>
  void put(double weight, double data, double model, const std::array<double, N>& by_global, double by_onset,
           double by_onset_force, double constant_share) {
    double drift = 0.0;
    for (std::size_t i = 0; i < drifts_; ++i) drift += values_.drift[i] * basis_[i];
    begin_row(weight * (data - (force_ * drift + constant_share * constant_ + model)));
    if (jacobian_ != nullptr) {
      for (const double derivative : by_global) add(-weight * derivative);
      if (has_exponent_) add(-weight * by_exponent(by_global[kLogStiffness], by_global[kLogFrequency]));
      if (has_difference_) add(0.0);
      if (has_constant_) add(level_per_cycle_ ? 0.0 : -weight * constant_share * level_unit_);
      for (std::size_t i = 0; i < drifts_; ++i) add(-weight * force_ * basis_[i]);
      add(-weight * by_onset);
      add(-weight * by_onset_force);
      if (level_per_cycle_) add(-weight * constant_share * force_);
    }
    basis_ += columns_;
  }

  /// F_s of this cycle against the population's: A + c V - (F_s - F_k(0+)).
  void tie_static_friction(const CycleFrame& frame, std::size_t globals) {
    const double weight = 1.0 / scales_.population->onset_sd;
    const double drag = 2.0 * frame.zeta * frame.force_scale;
    begin_row(weight * (scales_.population->force * *values_.difference - frame.onset_force - drag));
    if (jacobian_ == nullptr) return;
    for (const double derivative : {drag, -drag, 2.0 * frame.force_scale}) add(-weight * derivative);
    for (std::size_t i = kFrictionSlope; i < globals; ++i) add(0.0);
    if (has_exponent_) add(-weight * by_exponent(drag, -drag));
    add(weight * scales_.population->force);
    if (has_constant_) add(0.0);
    for (std::size_t i = 0; i < drifts_; ++i) add(0.0);
    add(0.0);
    add(-weight * scales_.force);
    if (level_per_cycle_) add(0.0);
  }

  /// A level of its own against the population's.
  void tie_level(std::size_t globals) {
    const double weight = 1.0 / scales_.population->level_sd;
    const double unit = scales_.population->force;
    begin_row(weight * (unit * *values_.constant - scales_.level - scales_.force * values_.local[2]));
    if (jacobian_ == nullptr) return;
    for (std::size_t i = 0; i < globals; ++i) add(0.0);
    if (has_exponent_) add(0.0);
    add(0.0);
    add(weight * unit);
    for (std::size_t i = 0; i < drifts_; ++i) add(0.0);
    add(0.0);
    add(0.0);
    add(-weight * scales_.force);
  }

 private:
  /// Of the derivatives by ln k and ln w_n. docs/model.md (26)
  [[nodiscard]] double by_exponent(double by_log_stiffness, double by_log_frequency) const {
    return log_speed_ * (by_log_stiffness + 0.5 * by_log_frequency);
  }

  void begin_row(double residual) {
    *residuals_++ = residual;
    at_ = jacobian_ != nullptr ? jacobian_++ : nullptr;
  }
  void add(double derivative) {
    *at_ = derivative;
    at_ += stride_;
  }

  const CycleValues values_;
  double* residuals_;
  double* jacobian_;
  double* at_ = nullptr;  // next column of the row
  const double* basis_;   // of the level's columns behind the constant
  std::size_t columns_;   // of the level
  std::ptrdiff_t stride_;
  const Scales& scales_;
  double force_;
  double level_unit_;
  std::size_t drifts_;
  double log_speed_;
  bool has_exponent_;
  bool has_difference_;
  bool level_per_cycle_;
  bool has_constant_;
  double constant_;  // force of the level without its drift
};

/// F = level + u z(tau; z0, law), tau = w_n (t - onset), z0 = A / u, u = k V / w_n
template <class Law>
void CycleModel::fill(const Law& law, const CycleFrame& frame, Rows rows) const {
  const double u = frame.force_scale;
  const double w = frame.omega_rad_per_s;
  const double z0 = frame.z0();
  const double by_noise = 1.0 / scales_.noise;
  const double onset_unit = -u * w * scales_.half_period_s;
  const double force_unit = scales_.force;
  constexpr std::size_t kOfLaw = std::tuple_size_v<decltype(law.by_law(typename Law::Point{}))>;
  const auto put_point = [&](double weight, double force, double tau, const typename Law::Point& p) {
    const double scale_part = u * (p.z - z0 * p.d_z0);  // d / d ln u at fixed tau
    std::array<double, 2 + kOfLaw> by_global{scale_part, -scale_part + u * (p.d_tau * tau + law.by_log_omega(p))};
    const std::array<double, kOfLaw> by_law = law.by_law(p);
    for (std::size_t i = 0; i < kOfLaw; ++i) by_global[2 + i] = u * by_law[i];
    rows.put(weight, force, u * p.z, by_global, onset_unit * p.d_tau, force_unit * p.d_z0, 1.0);
  };
  typename Law::Samples samples(law, w * even_step_s_);
  const std::size_t count = data_->time_s.size();
  const double* const time_s = data_->time_s.data();
  const double* const force = data_->force.data();
  const double* const weight = data_->weight.empty() ? nullptr : data_->weight.data();
  for (std::size_t i = 0; i < count; ++i) {
    const double tau = frame.tau_at(time_s[i]);
    put_point(weight == nullptr ? by_noise : by_noise * weight[i], force[i], tau, samples.at(tau));
  }
  const double rate = u * w;  // k V
  const auto put_bin = [&](const StickBin& bin, double tau, const typename Law::Point& p) {
    put_point(by_noise * std::sqrt(bin.count), bin.force, tau, p);
    rows.put(by_noise * std::sqrt(bin.time_spread), bin.slope, rate, std::array<double, 2 + kOfLaw>{rate}, 0.0, 0.0,
             0.0);
  };
  const auto tau_of = [&](const StickBin& bin) { return frame.tau_at(bin.time_s); };
  for (const StickBin& bin : data_->bins_before) put_bin(bin, tau_of(bin), law.before_slip(tau_of(bin)));
  for (const StickBin& bin : data_->bins_after) put_bin(bin, tau_of(bin), law.after_slip(tau_of(bin)));
  if (!scales_.population) return;
  rows.tie_static_friction(frame, globals());
  if (level_->per_cycle) rows.tie_level(globals());
}

bool CycleModel::evaluate(const CycleValues& values, double* residuals, double* jacobian) const {
  Rows rows(*this, values, residuals, jacobian);
  const Globals globals = globals_at_speed(values);
  if (!is_integrated()) {
    const std::optional<CycleState> now = state(globals.data(), values.local);
    if (now) std::visit([&](const auto& law) { fill(law, *now, rows); }, now->motion);
    return now.has_value();
  }
  const CycleFrame f = frame(globals.data(), values.local);
  const auto motion = SpeedDependentCycle::solve(f.z0(), globals.data(), scales_);
  if (motion) fill(*motion, f, rows);
  return motion.has_value();
}

bool CycleModel::is_inside(const CycleValues& values) const {
  return state(globals_at_speed(values).data(), values.local).has_value();
}

}  // namespace slipfit::fit
