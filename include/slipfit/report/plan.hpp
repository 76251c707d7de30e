#pragma once

#include <string>

#include "slipfit/predict/plan.hpp"
#include "slipfit/report/prediction.hpp"

namespace slipfit {

/// One document of the schema slipfit.plan/1 (docs/formats.md), without a trailing newline.
std::string to_json(const Plan& plan, const PredictionSource& source);

/// For people: what to measure next, and what limits each parameter.
std::string to_text(const Plan& plan, const PredictionSource& source);

}  // namespace slipfit
