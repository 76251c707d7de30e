#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "slipfit/analysis.hpp"

namespace slipfit {

/// A quantity of a recording other than the parameters: its key in the document, its words and SI unit for people.
template <class Owner>
struct Quantity {
  std::string_view key, words, unit;
  Estimate Owner::*estimate;
};

/// Predictions of the model at the recording's own speed.
inline constexpr std::array<Quantity<Derived>, 6> kPredicted{
    {{"periodic_displacement_m", "periodic displacement", "m", &Derived::periodic_displacement_m},
     {"lambda", "lambda", "", &Derived::lambda},
     {"lambda_critical", "lambda at the stick-slip limit", "", &Derived::lambda_critical},
     {"critical_speed_m_per_s", "critical speed", "m/s", &Derived::critical_speed_m_per_s},
     {"gamma", "F_s / F_k (gamma)", "", &Derived::gamma},
     {"micro_vibration_spacing_m", "micro-vibration spacing (estimate)", "m", &Derived::micro_vibration_spacing_m}}};

/// Quantities that follow from speed and frequency without a model.
inline constexpr std::array<Quantity<Derived>, 2> kMeasured{
    {{"pattern_spacing_m", "pattern spacing", "m", &Derived::pattern_spacing_m},
     {"impulse_rate_per_m", "impulses along the path", "1/m", &Derived::impulse_rate_per_m}}};

/// Coefficients of friction, available if a load is known.
inline constexpr std::array<Quantity<Coefficients>, 3> kCoefficients{
    {{"static_first_peak", "static, first peak", "", &Coefficients::static_first_peak},
     {"static_mean_peak", "static, mean of the peaks", "", &Coefficients::static_mean_peak},
     {"kinetic_mean", "kinetic, mean while sliding", "", &Coefficients::kinetic_mean}}};

/// Transients in newtons; `breakaway_force` has the unit of the force column.
inline constexpr std::array<Quantity<Transients>, 4> kTransients{
    {{"loading_stiffness_N_per_m", "slope of the loading ramp / V", "N/m", &Transients::loading_stiffness_N_per_m},
     {"breakaway_force_N", "first peak (breakaway)", "N", &Transients::breakaway_force},
     {"ringdown_frequency_Hz", "ring-down, frequency", "Hz", &Transients::ring_down_frequency_Hz},
     {"ringdown_damping_ratio", "ring-down, damping ratio", "", &Transients::ring_down_damping_ratio}}};

/// Coefficients in the first and last third, which show a change of friction.
inline constexpr std::array<Quantity<Coefficients>, 2> kCoefficientThirds{
    {{"kinetic_first_third", "kinetic, first third", "", &Coefficients::kinetic_first_third},
     {"kinetic_last_third", "kinetic, last third", "", &Coefficients::kinetic_last_third}}};

/// The scatter of the coefficients.
struct CoefficientSpread {
  std::string_view key, words;
  std::optional<double> Coefficients::*value;
};
inline constexpr std::array<CoefficientSpread, 2> kCoefficientSpreads{
    {{"static_peak_sd", "scatter of the peaks (sd)", &Coefficients::static_peak_sd},
     {"kinetic_sd", "scatter of the force while sliding (sd)", &Coefficients::kinetic_sd}}};

/// The fit at every sample of the recording, not a number where it does not reach.
inline std::vector<double> fitted_force(const Recording& recording, const Analysis& analysis) {
  std::vector<double> fitted(recording.size(), std::numeric_limits<double>::quiet_NaN());
  if (!analysis.fit) return fitted;
  for (const CurvePoint& point : analysis.fit->curve) {
    if (point.sample < fitted.size()) fitted[point.sample] = point.force;
  }
  return fitted;
}

/// The measured force less the interference that was fitted with the slips; where the fit does not reach, as measured.
inline std::vector<double> force_without_interference(const Recording& recording, const Analysis& analysis) {
  std::vector<double> force(recording.force().begin(), recording.force().end());
  if (!analysis.fit) return force;
  for (const CurvePoint& point : analysis.fit->curve) {
    if (point.sample < force.size()) force[point.sample] -= point.interference;
  }
  return force;
}

}  // namespace slipfit
