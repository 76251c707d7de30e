#include "fit/problem/ramp_residual.hpp"

#include <limits>
#include <optional>
#include <variant>

namespace slipfit::fit {

RampResidual ramp_residual(const BlockFit& fit, std::size_t first, const Coordinates& values, const double* local_first,
                           const double* local_second) {
  const Scales& scales = fit.scales();
  const std::optional<CycleState> s = fit.model(first).state(values, local_first);
  if (!s) return {std::numeric_limits<double>::quiet_NaN(), {}, {}, {}};
  const model::StickLine& after = std::get<CoulombCycle>(s->motion).wave.after;
  const double weight = 1.0 / (scales.noise * kRampTolerance);
  const double rate = s->stiffness_N_per_m * scales.speed_m_per_s;
  const double second_onset_s = fit.reference_s(first + 1) + scales.half_period_s * local_second[0];
  const double elapsed_s = second_onset_s - s->onset_s;
  const double u = s->force_scale;
  // d(u I) / d ln u at fixed A: I depends on z0 = A / u
  const double scale_part = u * (after.intercept - s->z0() * after.d_z0);
  RampResidual ramp;
  ramp.value = weight * (rate * elapsed_s + u * after.intercept - scales.force * local_second[1]);
  ramp.d_values = {weight * (rate * elapsed_s + scale_part), -weight * scale_part, weight * u * after.d_zeta};
  ramp.d_first = {-weight * rate * scales.half_period_s, weight * scales.force * after.d_z0};
  ramp.d_second = {weight * rate * scales.half_period_s, -weight * scales.force};
  return ramp;
}

}  // namespace slipfit::fit
