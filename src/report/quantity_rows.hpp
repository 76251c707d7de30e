#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "report/format.hpp"
#include "slipfit/analysis.hpp"
#include "slipfit/predict/prediction.hpp"
#include "slipfit/report/quantities.hpp"
#include "slipfit/surface/surface.hpp"

namespace slipfit {

/// A quantity with its value in a part of a result.
template <class Owner>
struct QuantityOf : Quantity {
  Estimate (*of)(const Owner&);
  bool is_number = false;                                   ///< a value without error or interval
  std::optional<double> (*spread)(const Owner&) = nullptr;  ///< standard deviation over the cycles
};

namespace quantities {

template <class Owner, class Value>
Owner owner_of(Value Owner::*);

template <auto Member>
using OwnerOf = decltype(owner_of(Member));

inline Estimate as_estimate(const Estimate& estimate) {
  return estimate;
}
inline Estimate as_estimate(const std::optional<Estimate>& estimate) {
  return estimate.value_or(Estimate{});
}
inline Estimate as_estimate(std::optional<double> value) {
  return {value, {}, {}, {}};
}

template <auto Member, auto Spread = nullptr>
constexpr QuantityOf<OwnerOf<Member>> row(std::string_view section, std::string_view key, std::string_view words,
                                          std::string_view unit) {
  using Owner = OwnerOf<Member>;
  constexpr bool kIsNumber =
      std::is_same_v<std::remove_cvref_t<decltype(std::declval<Owner>().*Member)>, std::optional<double>>;
  QuantityOf<Owner> quantity{
      {section, key, words, unit}, [](const Owner& owner) { return as_estimate(owner.*Member); }, kIsNumber};
  if constexpr (Spread != nullptr) quantity.spread = [](const Owner& owner) { return owner.*Spread; };
  return quantity;
}

}  // namespace quantities

using quantities::row;

inline constexpr auto kFrequency =
    row<&FrequencyReport::quoted>("frequency", "frequency_Hz", "frequency of the slips", "Hz");

/// Properties of the cycles without a model; forces have the unit of the force column.
inline constexpr std::array kCycleQuantities{
    row<&CycleStatistics::period_s, &CycleStatistics::period_sd_s>("cycles", "period_s", "period", "s"),
    row<&CycleStatistics::slip_time_s>("cycles", "slip_time_s", "slip time", "s"),
    row<&CycleStatistics::stick_time_s>("cycles", "stick_time_s", "stick time", "s"),
    row<&CycleStatistics::sticking_degree>("cycles", "sticking_degree", "sticking degree", ""),
    row<&CycleStatistics::peak_force, &CycleStatistics::peak_force_sd>("cycles", "peak_force_N", "peak force", "N"),
    row<&CycleStatistics::trough_force>("cycles", "trough_force_N", "trough force", "N"),
    row<&CycleStatistics::force_drop, &CycleStatistics::force_drop_sd>("cycles", "force_drop_N", "force drop", "N"),
    row<&CycleStatistics::stick_stiffness>("cycles", "stick_stiffness_N_per_m", "slope of the sticks / V", "N/m")};

/// Predictions of the model at the recording's own speed.
inline constexpr std::array kPredicted{
    row<&Derived::periodic_displacement_m>("derived", "periodic_displacement_m", "periodic displacement", "m"),
    row<&Derived::lambda>("derived", "lambda", "lambda", ""),
    row<&Derived::lambda_critical>("derived", "lambda_critical", "lambda at the stick-slip limit", ""),
    row<&Derived::critical_speed_m_per_s>("derived", "critical_speed_m_per_s", "critical speed", "m/s"),
    row<&Derived::gamma>("derived", "gamma", "F_s / F_k (gamma)", ""),
    row<&Derived::micro_vibration_spacing_m>("derived", "micro_vibration_spacing_m",
                                             "micro-vibration spacing (estimate)", "m")};

/// Quantities that follow from speed and frequency without a model.
inline constexpr std::array kMeasured{
    row<&Derived::pattern_spacing_m>("derived", "pattern_spacing_m", "pattern spacing V/f", "m"),
    row<&Derived::impulse_rate_per_m>("derived", "impulse_rate_per_m", "impulses along the path", "1/m"),
    row<&Derived::pattern_spacing_sd_m>("derived", "pattern_spacing_sd_m", "spread of the spacing over cycles (sd)",
                                        "m")};

/// The pattern on the worn surface, compared with that of the force.
inline constexpr std::array kOnSurface{
    row<&Derived::surface_spacing_m>("derived", "surface_spacing_m", "pattern on the worn surface", "m"),
    row<&Derived::surface_ratio>("derived", "surface_ratio", "over the spacing by force (V/f)", ""),
    row<&Derived::surface_En>("derived", "surface_En", "E_n of the two (agreement within +-1)", "")};

/// Coefficients of friction, available if a load is known.
inline constexpr std::array kCoefficients{
    row<&Coefficients::static_first_peak>("coefficients", "static_first_peak", "static, first peak", ""),
    row<&Coefficients::static_mean_peak>("coefficients", "static_mean_peak", "static, mean of the peaks", ""),
    row<&Coefficients::kinetic_mean>("coefficients", "kinetic_mean", "kinetic, mean while sliding", "")};

/// Coefficients in the first and last third, which show a change of friction.
inline constexpr std::array kCoefficientThirds{
    row<&Coefficients::kinetic_first_third>("coefficients", "kinetic_first_third", "kinetic, first third", ""),
    row<&Coefficients::kinetic_last_third>("coefficients", "kinetic_last_third", "kinetic, last third", "")};

/// The scatter of the coefficients.
inline constexpr std::array kCoefficientSpreads{
    row<&Coefficients::static_peak_sd>("coefficients", "static_peak_sd", "scatter of the peaks (sd)", ""),
    row<&Coefficients::kinetic_sd>("coefficients", "kinetic_sd", "scatter of the force while sliding (sd)", "")};

/// Events before and after the sliding; forces have the unit of the force column.
inline constexpr std::array kTransients{
    row<&Transients::loading_stiffness_N_per_m>("transients", "loading_stiffness_N_per_m",
                                                "slope of the loading ramp / V", "N/m"),
    row<&Transients::breakaway_force>("transients", "breakaway_force_N", "first peak (breakaway)", "N"),
    row<&Transients::ring_down_frequency_Hz>("transients", "ringdown_frequency_Hz", "ring-down, frequency", "Hz"),
    row<&Transients::ring_down_damping_ratio>("transients", "ringdown_damping_ratio", "ring-down, damping ratio", "")};

/// The motion at another speed, a row of a prediction.
inline constexpr std::array kMotionQuantities{
    row<&PredictedMotion::lambda>("rows", "lambda", "lambda", ""),
    row<&PredictedMotion::period_s>("rows", "period_s", "period", "s"),
    row<&PredictedMotion::frequency_Hz>("rows", "frequency_Hz", "frequency", "Hz"),
    row<&PredictedMotion::slip_time_s>("rows", "slip_time_s", "slip time", "s"),
    row<&PredictedMotion::stick_time_s>("rows", "stick_time_s", "stick time", "s"),
    row<&PredictedMotion::sticking_degree>("rows", "sticking_degree", "sticking degree", ""),
    row<&PredictedMotion::periodic_displacement_m>("rows", "periodic_displacement_m", "periodic displacement", "m"),
    row<&PredictedMotion::micro_vibration_spacing_m>("rows", "micro_vibration_spacing_m",
                                                     "micro-vibration spacing (estimate)", "m"),
    row<&PredictedMotion::force_peak_N>("rows", "force_peak_N", "peak force", "N"),
    row<&PredictedMotion::force_trough_N>("rows", "force_trough_N", "trough force", "N")};

/// The pattern on a worn surface, in its own document.
inline constexpr std::array kPattern{
    row<&Surface::spacing_m>("surface", "spacing_m", "spacing", "m"),
    row<&Surface::fine_spacing_m>("surface", "fine_spacing_m", "fine spacing", "m"),
    row<&Surface::spacing_sd_m>("surface", "spacing_sd_m", "scatter of the located ridges", "m"),
    row<&Surface::begin_spacing_m>("surface", "spacing_begin_m", "spacing at the start", "m"),
    row<&Surface::end_spacing_m>("surface", "spacing_end_m", "spacing at the end", "m"),
    row<&Surface::asymmetry>("surface", "asymmetry", "rise over fall", ""),
    row<&Surface::rsm_m>("surface", "rsm_m", "RSm", "m"),
    row<&Surface::cutoff_m>("surface", "cutoff_m", "cut-off wavelength of the waves", "m"),
    row<&Surface::smoothed_over_m>("surface", "smoothed_over_m", "ridges smoothed over", "m")};

/// Returns the end of a key: "_N_s_per_m" of "N s/m".
std::string suffix_of(std::string_view unit);
/// "period_low_s" of "period_s" and "_low": the key of a property of the quantity.
std::string key_of(const Quantity& quantity, std::string_view property);

/// Returns the unit to show a value in: a suitable one, that of the force column, or that of the stated speed.
DisplayUnit unit_of(const Quantity& quantity, const Estimate& estimate, const Conditions& conditions);
EstimateRow estimate_row(const Quantity& quantity, const Estimate& estimate, const Conditions& conditions);

/// The fit at every sample of the recording, not a number where it does not reach.
std::vector<double> fitted_force(const Recording& recording, const Analysis& analysis);
/// The measured force less the interference that was fitted with the slips; where the fit does not reach, as measured.
std::vector<double> force_without_interference(const Recording& recording, const Analysis& analysis);

}  // namespace slipfit
