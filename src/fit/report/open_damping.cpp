#include "fit/report/open_damping.hpp"

#include <cmath>

namespace slipfit::fit {

bool is_damping_open(const FitResult& result) {
  const Parameter* const zeta = result.find(ParameterId::DampingRatio);
  if (zeta == nullptr || zeta->status != ParameterStatus::Weak || !zeta->estimate.ci95) return false;
  return zeta->estimate.ci95->low <= 0.0 && zeta->estimate.ci95->high >= 1.0;
}

void tell_open_damping(FitResult& result) {
  for (Parameter& parameter : result.parameters) {
    if (parameter.id != ParameterId::DampingRatio) continue;
    const double error = 1.0 / std::sqrt(12.0);  // anything between 0 and 1 is as likely
    parameter.estimate = {0.0, error, Interval{0.0, 1.0}, "it can lie anywhere between 0 and 1: the fit takes 0"};
    parameter.status = ParameterStatus::Weak;
  }
  if (result.estimate) result.estimate->damping_identified = false;
  result.conditional_on.emplace_back("a damping ratio of 0, of which the recordings say nothing");
}

}  // namespace slipfit::fit
