#pragma once

#include <array>
#include <string_view>

#include "slipfit/predict/prediction.hpp"

namespace slipfit {

/// A quantity of a predicted motion: its key is name + unit_suffix ("period" + "_s"); docs/formats.md lists them.
struct PredictedQuantity {
  std::string_view name;
  std::string_view unit_suffix;
  Estimate PredictedMotion::*estimate;
};

inline constexpr std::array<PredictedQuantity, 10> kPredictedQuantities{{
    {"lambda", "", &PredictedMotion::lambda},
    {"period", "_s", &PredictedMotion::period_s},
    {"frequency", "_Hz", &PredictedMotion::frequency_Hz},
    {"slip_time", "_s", &PredictedMotion::slip_time_s},
    {"stick_time", "_s", &PredictedMotion::stick_time_s},
    {"sticking_degree", "", &PredictedMotion::sticking_degree},
    {"periodic_displacement", "_m", &PredictedMotion::periodic_displacement_m},
    {"micro_vibration_spacing", "_m", &PredictedMotion::micro_vibration_spacing_m},
    {"force_peak", "_N", &PredictedMotion::force_peak_N},
    {"force_trough", "_N", &PredictedMotion::force_trough_N},
}};

}  // namespace slipfit
