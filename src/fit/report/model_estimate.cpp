#include "fit/report/model_estimate.hpp"

#include <algorithm>
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

/// Returns one of kModelParameters that the model contains.
Jet value_of(const SlidingModel& model, ParameterId id) {
  switch (id) {
    case ParameterId::Stiffness:
      return model.stiffness;
    case ParameterId::NaturalFrequency:
      return model.omega;
    case ParameterId::DampingRatio:
      return model.zeta;
    case ParameterId::FrictionDifference:
      return model.difference;
    case ParameterId::FrictionSlope:
      return model.slope;
    case ParameterId::Alpha:
      return model.alpha;
    case ParameterId::Ageing:
      return model.ageing;
    case ParameterId::AgeingTime:
      return model.ageing_time;
    case ParameterId::ReloadForce:
      return model.reload->force_N;
    case ParameterId::ReloadLength:
      return model.reload->length_m;
    case ParameterId::StiffnessExponent:
      return model.stiffness_exponent;
    case ParameterId::Relaxation:
      return model.relaxation->share;
    default:
      return model.relaxation->time_s;
  }
}

}  // namespace

std::optional<EstimatedModel> model_of(const Findings& findings, const SlidingModel& model) {
  const bool damping_known = findings.held[kDamping] || findings.damping_known();
  const bool resolved =
      !findings.weakens && findings.slip_unresolved.empty() && !findings.difference_bounds && findings.in_newtons;
  if (!resolved || !damping_known || !(model.difference.a > 0.0)) return std::nullopt;
  ModelEstimate estimate{model.stiffness.a, model.omega.a, model.zeta.a, model.difference.a};
  if (findings.law && findings.law->depends_on_speed) {
    estimate.speed_dependence = SpeedDependence{model.slope.a, model.alpha.a};
  }
  if (findings.law && findings.law->ageing) {
    estimate.ageing = Ageing{model.ageing.a, findings.units.stick_s, model.ageing_time.a};
  }
  if (model.reload) estimate.reloading = Reloading{model.reload->force_N.a, model.reload->length_m.a};
  if (findings.law && findings.law->stiffness_grows) {
    estimate.stiffness_trend = StiffnessTrend{model.stiffness_exponent.a, findings.units.speed_m_per_s};
  }
  if (model.relaxation) estimate.relaxing = RelaxingSpring{model.relaxation->share.a, model.relaxation->time_s.a};
  std::vector<std::size_t> used;
  std::vector<Jet> entering;  // the covariance
  for (std::size_t i = 0; i < kModelValues; ++i) {
    const ParameterId id = kModelParameters[i];
    if (estimate.find(id) == nullptr) continue;
    used.push_back(i);
    entering.push_back(enters_as_logarithm(id) ? log(value_of(model, id)) : value_of(model, id));
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    for (std::size_t j = 0; j < used.size(); ++j) {
      estimate.covariance[used[i]][used[j]] = findings.intervals.whole_covariance(entering[i], entering[j]);
    }
  }
  estimate.degrees_of_freedom =
      std::min(findings.intervals.degrees_of_freedom(model.difference), findings.intervals.spread().degrees_of_freedom);
  estimate.damping_identified = findings.held[kDamping] || findings.damping.ci95->low > 0.0;
  Correlation correlation = correlation_of(estimate, used);
  return EstimatedModel{estimate, std::move(correlation)};
}

}  // namespace slipfit::fit
