#include "fit/cycle_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

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

CycleModel::CycleModel(const CycleData& data, const Scales& scales, double reference_s, LevelModel level)
    : data_(&data), scales_(scales), reference_s_(reference_s), level_(std::move(level)) {
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

/// gradient: d model / d (ln k, ln w_n, zeta, onset, onset force); the level's derivatives come from `basis`.
void CycleModel::put(std::size_t row, double weight, double data, double model, const std::array<double, 5>& gradient,
                     const double* basis, double* residuals, const Jacobians& jacobians) const {
  residuals[row] = weight * (data - model);
  if (jacobians.shared != nullptr) {
    for (std::size_t i = 0; i < kShared; ++i) jacobians.shared[row * kShared + i] = -weight * gradient[i];
  }
  if (jacobians.level != nullptr) {
    for (std::size_t i = 0; i < level_.columns(); ++i) {
      jacobians.level[row * level_.columns() + i] = -weight * scales_.force * basis[i];
    }
  }
  if (jacobians.own != nullptr) {
    double* own = jacobians.own + row * own_parameters();
    own[0] = -weight * gradient[3];
    own[1] = -weight * gradient[4];
  }
}

bool CycleModel::evaluate(const double* shared, const double* level, const double* own, double* residuals,
                          const Jacobians& jacobians) const {
  CycleState s;
  if (!state(shared, own, s)) return false;
  const double u = s.force_scale;
  const double w = s.omega_rad_per_s;
  const double rate = u * w;  // k V
  const double constant = level_.per_cycle ? scales_.level + scales_.force * own[2] : scales_.level;
  const double* basis = basis_.data();
  const std::size_t columns = level_.columns();
  const auto level_part = [&](const double* row) {
    double sum = 0.0;
    for (std::size_t i = 0; i < columns; ++i) sum += level[i] * row[i];
    return scales_.force * sum;
  };
  // F = level + u z(tau; z0, zeta), tau = w_n (t - onset), z0 = A / u, u = k V / w_n
  const auto gradient_of = [&](const model::WavePoint& p, double tau) {
    const double scale_part = u * (p.z - s.slip.z0 * p.d_z0);  // d / d ln u at fixed tau
    return std::array<double, 5>{scale_part, -scale_part + u * (p.d_tau * tau + p.d_log_omega), u * p.d_zeta,
                                 -u * p.d_tau * w * scales_.half_period_s, scales_.force * p.d_z0};
  };
  std::size_t row = 0;
  for (std::size_t i = 0; i < data_->time_s.size(); ++i, ++row, basis += columns) {
    const double tau = w * (data_->time_s[i] - s.onset_s);
    const model::WavePoint p = wave_at(s, tau);
    const double weight = data_->weight.empty() ? 1.0 : data_->weight[i];
    put(row, weight / scales_.noise, data_->force[i], constant + level_part(basis) + u * p.z, gradient_of(p, tau),
        basis, residuals, jacobians);
  }
  const auto put_bin = [&](const StickBin& bin, const model::WavePoint& p, double tau) {
    put(row++, std::sqrt(bin.count) / scales_.noise, bin.force, constant + level_part(basis) + u * p.z,
        gradient_of(p, tau), basis, residuals, jacobians);
    basis += columns;
    put(row++, std::sqrt(bin.time_spread) / scales_.noise, bin.slope, level_part(basis) + rate,
        {rate, 0.0, 0.0, 0.0, 0.0}, basis, residuals, jacobians);
    basis += columns;
  };
  for (const StickBin& bin : data_->bins_before) {
    const double tau = w * (bin.time_s - s.onset_s);
    put_bin(bin, stick_before(s, tau), tau);
  }
  for (const StickBin& bin : data_->bins_after) {
    const double tau = w * (bin.time_s - s.onset_s);
    put_bin(bin, stick_after(s, tau), tau);
  }
  if (level_.per_cycle && jacobians.own != nullptr) {
    std::size_t r = 0;
    for (; r < data_->time_s.size(); ++r) {
      const double weight = data_->weight.empty() ? 1.0 : data_->weight[r];
      jacobians.own[3 * r + 2] = -weight * scales_.force / scales_.noise;
    }
    const auto bin_rows = [&](const std::vector<StickBin>& bins) {
      for (const StickBin& bin : bins) {
        jacobians.own[3 * r++ + 2] = -std::sqrt(bin.count) * scales_.force / scales_.noise;
        jacobians.own[3 * r++ + 2] = 0.0;
      }
    };
    bin_rows(data_->bins_before);
    bin_rows(data_->bins_after);
  }
  return true;
}

}  // namespace slipfit::fit
