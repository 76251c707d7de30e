#include "slipfit/fit/result.hpp"

#include <algorithm>

namespace slipfit {

const Parameter* FitResult::find(ParameterId id) const {
  const auto found =
      std::find_if(parameters.begin(), parameters.end(), [id](const Parameter& p) { return p.id == id; });
  return found == parameters.end() ? nullptr : &*found;
}

Estimate FitResult::estimate_of(ParameterId id) const {
  const Parameter* const parameter = find(id);
  return parameter != nullptr ? parameter->estimate : Estimate{};
}

}  // namespace slipfit
