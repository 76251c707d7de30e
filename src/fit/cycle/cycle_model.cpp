#include "fit/cycle/cycle_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "model/phasor.hpp"

namespace slipfit::fit {

void legendre(double x, std::size_t terms, double* values, double* derivatives) {
  for (std::size_t n = 0; n < terms; ++n) {
    const auto order = static_cast<double>(n);
    values[n] = n == 0   ? 1.0
                : n == 1 ? x
                         : ((2.0 * order - 1.0) * x * values[n - 1] - (order - 1.0) * values[n - 2]) / order;
    // P'_n = P'_(n-2) + (2n - 1) P_(n-1)
    derivatives[n] = n == 0 ? 0.0 : (2.0 * order - 1.0) * values[n - 1] + (n >= 2 ? derivatives[n - 2] : 0.0);
  }
}

namespace {

/// The step of evenly spaced times, 0 of others: samples left out, an uneven clock. A billionth of a step is far below
/// any noise and far above the rounding of written times.
double even_step_s(const std::vector<double>& time_s) {
  if (time_s.size() < 2) return 0.0;
  const double step_s = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (std::abs(time_s[i] - time_s.front() - step_s * static_cast<double>(i)) > 1e-9 * step_s) return 0.0;
  }
  return step_s;
}

}  // namespace

CycleModel::CycleModel(const CycleData& data, const Scales& scales, double reference_s, LevelModel level)
    : data_(&data),
      scales_(scales),
      reference_s_(reference_s),
      level_(std::move(level)),
      even_step_s_(even_step_s(data.time_s)) {
  fill_basis();
}

void CycleModel::fill_basis() {
  const std::size_t columns = level_.columns();
  basis_.resize(residuals() * columns);
  if (columns == 0) return;
  std::vector<double> values(level_.terms);
  std::vector<double> slopes(level_.terms);
  const double span_s = scales_.time_end_s - scales_.time_begin_s;
  double* out = basis_.data();
  const auto polynomial_at = [&](double time_s) {
    legendre(2.0 * (time_s - scales_.time_begin_s) / span_s - 1.0, level_.terms, values.data(), slopes.data());
  };
  for (const double time_s : data_->time_s) {
    polynomial_at(time_s);
    for (const double value : values) *out++ = value;
    for (const double line_Hz : level_.lines_Hz) {
      const double phase = 2.0 * std::numbers::pi * line_Hz * (time_s - scales_.time_begin_s);
      *out++ = std::cos(phase);
      *out++ = std::sin(phase);
    }
  }
  for (const auto* bins : {&data_->bins_before, &data_->bins_after}) {
    for (const StickBin& bin : *bins) {
      polynomial_at(bin.time_s);
      for (const double value : values) *out++ = value;
      for (const LineInBin& line : bin.lines) out = std::copy_n(line.mean.data(), 2, out);
      for (const double slope : slopes) *out++ = 2.0 / span_s * slope;
      for (const LineInBin& line : bin.lines) out = std::copy_n(line.slope.data(), 2, out);
    }
  }
}

bool CycleModel::state(const double* shared, const double* own, CycleState& state) const {
  state.stiffness_N_per_m = std::exp(shared[0]);
  state.omega_rad_per_s = std::exp(shared[1]);
  state.zeta = shared[2];
  state.force_scale = state.stiffness_N_per_m * scales_.speed_m_per_s / state.omega_rad_per_s;
  state.onset_s = reference_s_ + scales_.half_period_s * own[0];
  state.onset_force = scales_.force * own[1];
  const double z0 = state.onset_force / state.force_scale;
  if (!(z0 + 2.0 * state.zeta > 0.0) || !(std::abs(state.zeta) < 1.0) || !std::isfinite(z0)) return false;
  state.slip = model::solve_slip(z0, state.zeta);
  state.after = model::stick_after(state.slip);
  state.lag_tau = state.omega_rad_per_s * scales_.sensor_lag_s;
  return true;
}

bool CycleModel::evaluate(const double* shared, const double* level, const double* own, double* residuals,
                          double* jacobian) const {
  CycleState s;
  if (!state(shared, own, s)) return false;
  const double u = s.force_scale;
  const double w = s.omega_rad_per_s;
  const double rate = u * w;  // k V
  const auto rows = static_cast<std::ptrdiff_t>(this->residuals());
  const std::size_t columns = level_.columns();
  const double* basis = basis_.data();
  const auto level_part = [&] {
    double sum = 0.0;
    for (std::size_t i = 0; i < columns; ++i) sum += level[i] * basis[i];
    return scales_.force * sum;
  };
  // gradient: d model / d (ln k, ln w_n, zeta, onset, onset force, level of the cycle)
  const auto put = [&](double weight, double difference, const std::array<double, 6>& gradient) {
    *residuals++ = weight * difference;
    if (jacobian != nullptr) {
      double* at = jacobian++;
      const auto put_column = [&](double value) {
        *at = -weight * value;
        at += rows;
      };
      for (std::size_t i = 0; i < kShared; ++i) put_column(gradient[i]);
      for (std::size_t i = 0; i < columns; ++i) put_column(scales_.force * basis[i]);
      for (std::size_t i = kShared; i < kShared + own_parameters(); ++i) put_column(gradient[i]);
    }
    basis += columns;
  };
  // F = level + u z(tau; z0, zeta), tau = w_n (t - onset), z0 = A / u, u = k V / w_n
  const double constant = level_.per_cycle ? scales_.level + scales_.force * own[2] : scales_.level;
  const auto put_point = [&](double weight, double force, double tau, const model::WavePoint& p) {
    const double scale_part = u * (p.z - s.slip.z0 * p.d_z0);  // d / d ln u at fixed tau
    put(weight, force - (constant + level_part() + u * p.z),
        {scale_part, -scale_part + u * (p.d_tau * tau + p.d_log_omega), u * p.d_zeta,
         -u * p.d_tau * w * scales_.half_period_s, scales_.force * p.d_z0, scales_.force});
  };
  // At even steps a slip's cosine and sine turn by the same angle from sample to sample.
  const bool turns_evenly = even_step_s_ > 0.0 && s.lag_tau == 0.0;
  model::Phasor phasor(s.zeta, s.slip.b, w * even_step_s_);
  bool turning = false;
  for (std::size_t i = 0; i < data_->time_s.size(); ++i) {
    const double tau = w * (data_->time_s[i] - s.onset_s);
    const double weight = (data_->weight.empty() ? 1.0 : data_->weight[i]) / scales_.noise;
    if (turns_evenly && tau > 0.0 && tau <= s.slip.tau_end) {
      turning ? phasor.step() : phasor.start(tau);
      turning = true;
      put_point(weight, data_->force[i], tau, slip_at(s, tau, phasor.c(), phasor.s()));
    } else {
      put_point(weight, data_->force[i], tau, wave_at(s, tau));
    }
  }
  const auto put_bin = [&](const StickBin& bin, double tau, const model::WavePoint& p) {
    put_point(std::sqrt(bin.count) / scales_.noise, bin.force, tau, p);
    put(std::sqrt(bin.time_spread) / scales_.noise, bin.slope - (level_part() + rate), {rate, 0.0, 0.0, 0.0, 0.0, 0.0});
  };
  for (const StickBin& bin : data_->bins_before) {
    const double tau = w * (bin.time_s - s.onset_s);
    put_bin(bin, tau, stick_before(s, tau));
  }
  for (const StickBin& bin : data_->bins_after) {
    const double tau = w * (bin.time_s - s.onset_s);
    put_bin(bin, tau, stick_after(s, tau));
  }
  return true;
}

}  // namespace slipfit::fit
