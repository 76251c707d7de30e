#pragma once

#include <optional>
#include <string>

#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/fit.hpp"
#include "slipfit/model/motion.hpp"
#include "slipfit/predict/observed_end.hpp"

namespace slipfit {

/// Quantities that follow from the fit or from V and f (docs/model.md defines them).
struct Derived {
  Estimate lambda, gamma, lambda_critical, critical_speed_m_per_s;
  std::optional<Regime> regime;
  Estimate periodic_displacement_m;            ///< predicted by the fitted model at the recording's speed
  Estimate pattern_spacing_m;                  ///< measured: V/f, an identity that proves nothing about the model
  std::optional<double> pattern_spacing_sd_m;  ///< spread over cycles
  Estimate micro_vibration_spacing_m;          ///< estimate only, see docs/model.md section 8
  Estimate impulse_rate_per_m;                 ///< 1 / spacing
  std::optional<ObservedEnd> observed_end;     ///< of a sweep
  std::optional<Estimate> surface_spacing_m;   ///< on the worn track, where one was given; so for the next three
  std::optional<Estimate> surface_ratio;       ///< over pattern_spacing_m
  std::optional<Estimate> surface_En;          ///< (surface_spacing_m - pattern_spacing_m) / U, ISO 13528
  std::string surface_verdict;                 ///< one sentence
  std::optional<Estimate>
      measured_spacing_En;  ///< where `Conditions` has a measured spacing: (predicted - measured) / U
};

/// Returns the predictions of the fitted model at the recording's own speed; members that are measured without a model
/// are left empty.
Derived derive_from_model(const FitResult& fit, const Conditions& conditions);

/// Returns the end of stick-slip of a sweep, the only derived quantity that does not refer to one speed: by its fit, or
/// by its recordings if the fit does not determine it or contradicts them. All other members are left empty.
Derived derive_from_sweep(const FitResult& fit, const ObservedEnd& observed);

}  // namespace slipfit
