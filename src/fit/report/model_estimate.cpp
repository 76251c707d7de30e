#include "fit/report/model_estimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace slipfit::fit {
namespace {

/// Returns the correlation by the covariance of a model, for the rows and columns `used` (places in kModelParameters).
Correlation correlation_of(const ModelEstimate& estimate, const std::vector<std::size_t>& used) {
  Correlation correlation;
  for (const std::size_t i : used) {
    correlation.names.emplace_back(info(kModelParameters[i]).key);
    correlation.matrix.emplace_back();
    for (const std::size_t j : used) {
      const double scale = std::sqrt(std::max(0.0, estimate.covariance[i][i] * estimate.covariance[j][j]));
      correlation.matrix.back().push_back(i == j ? 1.0 : scale > 0.0 ? estimate.covariance[i][j] / scale : 0.0);
    }
  }
  return correlation;
}

/// In the order of kModelParameters; of the positive ones the logarithm.
std::array<Jet, kModelValues> values_of(const SlidingModel& model) {
  return {log(model.stiffness),
          log(model.omega),
          model.zeta,
          log(model.difference),
          model.slope,
          model.alpha,
          model.ageing,
          model.ageing_time,
          model.reload ? model.reload->force_N : Jet(0.0),
          model.reload ? log(model.reload->length_m) : Jet(0.0),
          model.stiffness_exponent,
          model.relaxation ? model.relaxation->share : Jet(0.0),
          model.relaxation ? log(model.relaxation->time_s) : Jet(0.0)};
}

}  // namespace

std::optional<EstimatedModel> model_of(const Findings& findings, const SlidingModel& model) {
  const bool damping_known = findings.held[kDamping] || findings.damping_known();
  const bool resolved =
      !findings.weakens && findings.slip_unresolved.empty() && !findings.difference_bounds && findings.in_newtons;
  if (!resolved || !damping_known || !(model.difference.a > 0.0)) return std::nullopt;
  const std::array<Jet, kModelValues> all = values_of(model);
  ModelEstimate estimate{model.stiffness.a, model.omega.a, model.zeta.a, model.difference.a};
  std::vector<std::size_t> used{0, 1, 2, 3};
  if (findings.law && findings.law->depends_on_speed) {
    estimate.speed_dependence = SpeedDependence{model.slope.a, model.alpha.a};
    used.insert(used.end(), {4, 5});
  }
  if (findings.law && findings.law->ageing) {
    estimate.ageing = Ageing{model.ageing.a, findings.units.stick_s, model.ageing_time.a};
    used.insert(used.end(), {6, 7});
  }
  if (model.reload) {
    estimate.reloading = Reloading{model.reload->force_N.a, model.reload->length_m.a};
    used.insert(used.end(), {8, 9});
  }
  if (findings.law && findings.law->stiffness_grows) {
    estimate.stiffness_trend = StiffnessTrend{model.stiffness_exponent.a, findings.units.speed_m_per_s};
    used.push_back(10);
  }
  if (model.relaxation) {
    estimate.relaxing = RelaxingSpring{model.relaxation->share.a, model.relaxation->time_s.a};
    used.insert(used.end(), {11, 12});
  }
  for (const std::size_t i : used) {
    for (const std::size_t j : used) estimate.covariance[i][j] = findings.intervals.whole_covariance(all[i], all[j]);
  }
  estimate.degrees_of_freedom =
      std::min(findings.intervals.degrees_of_freedom(model.difference), findings.intervals.spread().degrees_of_freedom);
  estimate.damping_identified = findings.held[kDamping] || findings.damping.ci95->low > 0.0;
  Correlation correlation = correlation_of(estimate, used);
  return EstimatedModel{estimate, std::move(correlation)};
}

}  // namespace slipfit::fit
