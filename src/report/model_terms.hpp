#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "slipfit/fit/result.hpp"

namespace slipfit {

/// An effect that the model of a fit includes besides stick-slip itself, with what is known of it.
struct ModelTerm {
  std::string_view code;  ///< where a warning reports the effect, too, that of the warning
  std::vector<ParameterId> parameters;
  std::string text;
};

/// Returns the effects in the model of a fit.
std::vector<ModelTerm> model_terms(const FitResult& fit);

}  // namespace slipfit
