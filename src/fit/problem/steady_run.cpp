#include "fit/problem/steady_run.hpp"

#include <cmath>

#include "fit/law/speed_dependent.hpp"

namespace slipfit::fit {

/// F_k(V) = F_k(0+) + G g(V) / g(v_c), G = 2 v_c sqrt(k m) times kFrictionSlope. docs/model.md section 5
SteadyResidual steady_residual(const SteadyRun& run, const Units& units, FrictionLaw law, const Coordinates& values,
                               double level) {
  const double a = values(kFrictionRate);
  const double speed = run.speed_m_per_s / units.slip_speed_m_per_s;
  const SlopeRatio whole = slope_ratio(law, a);
  const SlopeRatio part = slope_ratio(law, a * speed);
  const double growth = speed * whole.value / part.value;  // g(V) / g(v_c)
  const double d_growth =
      speed * (whole.derivative / part.value - whole.value * part.derivative * speed / (part.value * part.value));
  const double weight = 1.0 / run.standard_error;
  const double impedance = std::exp(values(kLogStiffness) - values(kLogFrequency));  // sqrt(k m)
  const double unit = 2.0 * run.load * units.slip_speed_m_per_s * impedance;
  const double excess = unit * values(kFrictionSlope) * growth;
  SteadyResidual result;
  result.value = weight * (run.mean_force - run.load * units.force * level - excess);
  result.by_level = -weight * run.load * units.force;
  result.by_value(kLogStiffness) = -weight * excess;
  result.by_value(kLogFrequency) = weight * excess;
  result.by_value(kFrictionSlope) = -weight * unit * growth;
  result.by_value(kFrictionRate) = -weight * unit * values(kFrictionSlope) * d_growth;
  return result;
}

}  // namespace slipfit::fit
