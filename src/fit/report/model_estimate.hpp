#pragma once

#include <optional>

#include "fit/report/findings.hpp"
#include "slipfit/fit/result.hpp"

namespace slipfit::fit {

struct EstimatedModel {
  ModelEstimate estimate;
  Correlation correlation;
};

/// For everything that is computed from the fit. Needs all four of k, w_n, zeta and F_s above F_k.
std::optional<EstimatedModel> model_of(const Findings& findings, const SlidingModel& model);

}  // namespace slipfit::fit
