#pragma once

#include <array>

#include "slipfit/fit/result.hpp"

namespace slipfit {

/// Returns the model fitted to one recording with the uncertainty at other speeds: intervals there include ageing and
/// velocity dependence of the published size, and parameters that are neither identified nor fixed have at least a
/// stated error. `statuses` are those of the first four of kModelParameters.
ModelEstimate from_single_speed(ModelEstimate model, double speed_m_per_s,
                                const std::array<ParameterStatus, 4>& statuses);

/// Returns the model like the function above, with the statuses of the fit. `fit.estimate` must not be empty.
ModelEstimate from_single_speed(const FitResult& fit, double speed_m_per_s);

}  // namespace slipfit
