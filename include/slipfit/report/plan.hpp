#pragma once

#include <string>

#include "slipfit/predict/plan.hpp"
#include "slipfit/report/prediction.hpp"

namespace slipfit {

/// Writes one document of the schema slipfit.plan/1 (docs/formats.md), without a trailing newline.
std::string to_json(const Plan& plan, const PredictionSource& source);

/// Writes a text for people: what to measure next, and the limits of each parameter.
std::string to_text(const Plan& plan, const PredictionSource& source);

}  // namespace slipfit
