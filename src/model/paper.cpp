#include "slipfit/model/paper.hpp"

#include <cmath>
#include <numbers>
#include <optional>
#include <string>

namespace slipfit {
namespace {

/// lambda_d of [Paper] eq. (32) as a function of x = w_n t_slip; rounding below 0 counts as 0.
double lambda_d_at(double lambda, double zeta, double x) {
  // lambda^2 d^2 - (1 - d^2) with d = exp(-zeta x): the small difference without cancellation
  const double square = lambda * lambda * std::exp(-2.0 * zeta * x) + std::expm1(-2.0 * zeta * x);
  return std::sqrt(std::max(0.0, square));
}

/// Smallest root x of f = b x + atan lambda + atan lambda_d(x) - 2 pi, [Paper] eq. (36). f' = b - zeta / lambda_d: f
/// rises to its maximum at lambda_d = zeta / b and falls after it, so the root is left of the maximum or nowhere. f is
/// concave there: Newton's steps from the left never pass the root.
std::optional<double> smallest_slip(double lambda, double zeta) {
  const double b = std::sqrt(1.0 - zeta * zeta);
  const auto f = [&](double x) {
    return b * x + std::atan(lambda) + std::atan(lambda_d_at(lambda, zeta, x)) - 2.0 * std::numbers::pi;
  };
  double x = 2.0 * (std::numbers::pi - std::atan(lambda)) / b;  // as if lambda_d were lambda: too early
  if (zeta > 0.0) {
    const double top = (0.5 * std::log1p(lambda * lambda) + std::log(b)) / zeta;
    if (!(top > x) || !(f(top) >= 0.0)) return std::nullopt;
    for (int step = 0; step < 200; ++step) {
      const double lambda_d = lambda_d_at(lambda, zeta, x);
      const double next = x - f(x) / (b - zeta / lambda_d);
      if (!(next > x) || next >= top) break;
      x = next;
    }
  }
  return x;
}

}  // namespace

Result<PaperCycle> paper_cycle(const Slider& slider, const Friction& friction, double speed_m_per_s) {
  const double zeta = slider.damping_ratio();
  const double w_n = slider.natural_frequency_rad_per_s();
  const double length_m = speed_m_per_s / w_n;
  const double lambda = friction.difference_N() / (slider.stiffness_N_per_m() * length_m);
  const std::optional<double> x =
      zeta < 1.0 && lambda > 0.0 && std::isfinite(lambda) ? smallest_slip(lambda, zeta) : std::nullopt;
  if (!x) {
    return Error{"no_solution", "[Paper] eq. (36) has no root at lambda " + std::to_string(lambda) +
                                    ", damping ratio " + std::to_string(zeta) + ": use the exact solution"};
  }
  const double b = std::sqrt(1.0 - zeta * zeta);
  const double sticks = lambda + lambda_d_at(lambda, zeta, *x) - 2.0 * zeta;
  PaperCycle cycle;
  cycle.lambda_d = lambda_d_at(lambda, zeta, *x);
  cycle.delta_e = std::exp(-zeta * *x);
  cycle.delta_t = std::atan(cycle.lambda_d) / std::atan(lambda);
  cycle.delta_s = cycle.lambda_d / (lambda * cycle.delta_e);
  cycle.slip_s = *x / w_n;
  cycle.stick_s = sticks / (b * w_n);
  cycle.sticking_degree = cycle.stick_s / (cycle.stick_s + cycle.slip_s);
  cycle.displacement_printed_m = (lambda + cycle.lambda_d) * length_m + *x * length_m;
  cycle.displacement_corrected_m = (*x + sticks) * length_m;
  return cycle;
}

}  // namespace slipfit
