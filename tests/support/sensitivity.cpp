#include "support/sensitivity.hpp"

#include <ceres/jet.h>

#include <algorithm>

#include "model/slip.hpp"

namespace slipfit {
namespace {

using Jet = ceres::Jet<double, static_cast<int>(kSensitivityParameters)>;

Sensitive sensitive(const Jet& x) {
  Sensitive result;
  result.value = x.a;
  std::copy_n(x.v.data(), static_cast<std::size_t>(kSensitivityParameters), result.gradient.begin());
  return result;
}

}  // namespace

std::optional<CycleSensitivity> damped_sensitivity(const Slider& slider, const Friction& friction,
                                                   double speed_m_per_s) {
  const Jet k(slider.stiffness_N_per_m(), static_cast<int>(kStiffness));
  const Jet w_n(slider.natural_frequency_rad_per_s(), static_cast<int>(kNaturalFrequency));
  const Jet zeta(slider.damping_ratio(), static_cast<int>(kDampingRatio));
  const Jet f_s(friction.static_N(), static_cast<int>(kStaticFriction));
  const Jet f_k(friction.kinetic_N(), static_cast<int>(kKineticFriction));
  const Jet speed(speed_m_per_s, static_cast<int>(kDrivingSpeed));
  if (!(zeta.a < 1.0) || !(f_s.a > f_k.a)) return std::nullopt;

  const Jet scale = k * speed / w_n;
  const Jet z0 = (f_s - f_k) / scale - 2.0 * zeta;
  const auto cycle = model::coulomb_cycle(z0, zeta);
  if (!cycle) return std::nullopt;
  const Jet slip_s = cycle->slip / w_n;
  const Jet stick_s = cycle->stick / w_n;
  const Jet period_s = slip_s + stick_s;
  return CycleSensitivity{sensitive(slip_s),
                          sensitive(stick_s),
                          sensitive(period_s),
                          sensitive(speed * period_s),
                          sensitive(f_k + scale * cycle->peak),
                          sensitive(f_k + scale * cycle->trough),
                          sensitive(f_k + scale * z0),
                          sensitive(f_k + scale * (z0 - cycle->stick))};
}

}  // namespace slipfit
