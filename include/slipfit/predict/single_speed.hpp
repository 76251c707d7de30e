#pragma once

#include <array>

#include "slipfit/fit/result.hpp"

namespace slipfit {

/// The model fitted to one recording, with what one driving speed leaves open about others: intervals away from that
/// speed contain ageing and velocity dependence of the published size, and parameters that are neither identified nor
/// fixed have at least a stated error there. `statuses`: of the first four of kModelParameters.
ModelEstimate from_single_speed(ModelEstimate model, double speed_m_per_s,
                                const std::array<ParameterStatus, 4>& statuses);

/// The same, with the statuses of the fit. `fit.estimate` is not empty.
ModelEstimate from_single_speed(const FitResult& fit, double speed_m_per_s);

}  // namespace slipfit
