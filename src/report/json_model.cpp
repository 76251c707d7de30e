#include <algorithm>
#include <array>
#include <cmath>

#include "report/json_sections.hpp"
#include "report/names.hpp"

namespace slipfit {
namespace {

Json candidate_json(const Candidate& candidate, ForceQuantity quantity) {
  Json json{{"tier", name_of(candidate.tier)}, {"parameters", candidate.parameters}};
  ForceKeys forces(json, quantity);
  forces.put("rms", candidate.rms);
  json["aicc"] = number(candidate.aicc);
  json["chosen"] = candidate.chosen;
  json["reason"] = candidate.reason;
  forces.finish();
  return json;
}

/// Its place in ModelEstimate::covariance.
std::size_t place_of(const std::string& name) {
  const auto* const found = std::find_if(kModelParameters.begin(), kModelParameters.end(),
                                         [&name](ParameterId id) { return info(id).key == name; });
  return static_cast<std::size_t>(found - kModelParameters.begin());
}

/// What the covariance belongs to, in the order of Correlation::names. A value that the data hardly tell alone, and
/// whose parameter is therefore null, still stands here: together with the others it predicts.
Json working_values_json(const Correlation& correlation, const ModelEstimate& estimate) {
  const SpeedDependence law = estimate.speed_dependence.value_or(SpeedDependence{});
  const std::array<double, kModelValues> values{estimate.stiffness_N_per_m,
                                                estimate.natural_frequency_rad_per_s,
                                                estimate.damping_ratio,
                                                estimate.friction_difference_N,
                                                law.slope_N_s_per_m,
                                                law.alpha_s_per_m,
                                                estimate.ageing.value_or(Ageing{}).rate_N};
  Json json = Json::array();
  for (const std::string& name : correlation.names) json.push_back(number(values[place_of(name)]));
  return json;
}

/// With the matrix this is the whole covariance. Where zeta lies at 0 the se of the parameters is wider.
Json scaled_errors_json(const Correlation& correlation, const ModelEstimate& estimate) {
  Json errors = Json::array();
  for (const std::string& name : correlation.names) {
    const std::size_t i = place_of(name);
    errors.push_back(number(std::sqrt(std::max(0.0, estimate.covariance[i][i]))));
  }
  return errors;
}

}  // namespace

Json model_json(const FitResult& fit, ForceQuantity quantity) {
  Json candidates = Json::array();
  for (const Candidate& candidate : fit.candidates) candidates.push_back(candidate_json(candidate, quantity));
  Json residual = Json::object();
  ForceKeys forces(residual, quantity);
  forces.put("rms", fit.residual.rms);
  residual["reduced_chi2"] = number(fit.residual.reduced_chi2);
  residual["whiteness_p"] = number(fit.residual.whiteness_p);
  forces.finish();
  return Json{{"tier", name_of(fit.tier)},
              {"conditional_on", fit.conditional_on},
              {"candidates", std::move(candidates)},
              {"residual", std::move(residual)},
              {"degrees_of_freedom", fit.estimate ? number(fit.estimate->degrees_of_freedom) : Json(nullptr)}};
}

Json parameters_json(const FitResult& fit) {
  Json json = Json::object();
  for (const Parameter& parameter : fit.parameters) {
    json[std::string(parameter.name())] = {{"value", number(parameter.estimate.value)},
                                           {"se", number(parameter.estimate.standard_error)},
                                           {"ci95", interval(parameter.estimate.ci95)},
                                           {"status", name_of(parameter.status)},
                                           {"note", parameter.estimate.note}};
  }
  return json;
}

Json correlation_json(const FitResult& fit) {
  if (!fit.correlation) return nullptr;
  Json matrix = Json::array();
  for (const std::vector<double>& row : fit.correlation->matrix) {
    Json cells = Json::array();
    for (const double cell : row) cells.push_back(number(cell));
    matrix.push_back(std::move(cells));
  }
  Json json{{"names", fit.correlation->names}, {"matrix", std::move(matrix)}};
  if (fit.estimate) {
    json["values"] = working_values_json(*fit.correlation, *fit.estimate);
    json["scaled_se"] = scaled_errors_json(*fit.correlation, *fit.estimate);
  }
  return json;
}

Json tests_json(const std::vector<ShortTest>& tests) {
  Json json = Json::array();
  for (const ShortTest& test : tests) {
    json.push_back({{"name", test.name},
                    {"value", number(test.value)},
                    {"se", number(test.standard_error)},
                    {"p_value", number(test.p_value)},
                    {"finding", test.finding}});
  }
  return json;
}

Json derived_json(const Derived& derived) {
  Json json{{"lambda", estimate(derived.lambda)},
            {"gamma", estimate(derived.gamma)},
            {"lambda_critical", estimate(derived.lambda_critical)},
            {"critical_speed_m_per_s", estimate(derived.critical_speed_m_per_s)},
            {"regime", derived.regime ? Json(*derived.regime) : Json(nullptr)},
            {"bistable", derived.bistable ? Json(*derived.bistable) : Json(nullptr)},
            {"periodic_displacement_m", estimate(derived.periodic_displacement_m)},
            {"pattern_spacing_m", estimate(derived.pattern_spacing_m)},
            {"pattern_spacing_sd_m", estimate(Estimate{derived.pattern_spacing_sd_m, {}, {}, {}})},
            {"micro_vibration_spacing_m", estimate(derived.micro_vibration_spacing_m)},
            {"impulse_rate_per_m", estimate(derived.impulse_rate_per_m)}};
  if (derived.measured_spacing_En) json["measured_spacing_En"] = estimate(*derived.measured_spacing_En);
  return json;
}

}  // namespace slipfit
