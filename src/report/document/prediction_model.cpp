#include "report/document/prediction_model.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "report/document/json_node.hpp"

namespace slipfit::documents {
namespace {

/// A number >= 0, or null.
std::optional<double> checked_error(const JsonNode& node) {
  const std::optional<double> error = node.number();
  if (error && !(*error >= 0.0)) node.fail("a number >= 0 or null");
  return error;
}

/// Without these there is no prediction: the first of ModelEstimate::covariance.
constexpr std::span kNeeded = std::span(kModelParameters).first<4>();

std::string key_of(ParameterId id) {
  return std::string(info(id).key);
}

bool is_known(const std::string& status) {
  return status == "identified" || status == "weak" || status == "fixed" || status == "conditional";
}

[[noreturn]] void cannot_predict(const std::string& name, const std::string& why) {
  throw ThrownError(Error{"cannot_predict", fmt::format("'{}': cannot predict: {}", name, why)});
}

/// Refuses a document in which a needed parameter is not known, with the note of the fit.
void check_known(const std::string& file, const JsonNode& parameters) {
  std::vector<std::string> open;
  std::string note;
  for (const ParameterId id : kNeeded) {
    const std::string name = key_of(id);
    if (!parameters.has(name)) {
      open.push_back(name + " is absent");
      continue;
    }
    const JsonNode parameter = parameters.member(name);
    const std::string status = parameter.member("status").text();
    if (is_known(status)) continue;
    if (status != "bounded" && status != "unidentified") {
      parameter.member("status").fail("identified, weak, bounded, unidentified, fixed or conditional");
    }
    open.push_back(fmt::format("{} is {}", name, status));
    if (note.empty() && parameter.has("note")) note = parameter.member("note").text();
  }
  if (open.empty()) return;
  cannot_predict(file, fmt::format("{}{}; a prediction needs all four of k, w_n, zeta and F_s - F_k",
                                   fmt::join(open, ", "), note.empty() ? note : " (" + note + ")"));
}

double checked_value(const JsonNode& parameter, ParameterId id) {
  const bool is_damping = id == ParameterId::DampingRatio;
  const std::string expected = is_damping ? "a number in [0, 1)" : "a number > 0";
  const JsonNode node = parameter.member("value");
  const std::optional<double> value = node.number(expected);
  const bool is_inside = value && (is_damping ? *value >= 0.0 && *value < 1.0 : *value > 0.0);
  if (!is_inside) node.fail(expected);
  return *value;
}

/// Whether zeta is held by the user, or its interval lies above 0.
bool damping_identified(const JsonNode& damping) {
  if (damping.member("status").text() == "fixed") return true;
  const JsonNode bounds = damping.member("ci95");
  if (bounds.is_null()) return false;
  if (bounds.array_size() != 2) bounds.fail("[low, high] or null");
  const std::optional<double> low = bounds.element(0).number();
  return low && *low > 0.0;
}

/// Rows of ModelEstimate::covariance that the model has: the four, of friction that depends on the speed its slope and
/// rate, of static friction that ages its rate.
std::vector<std::size_t> places_of(const ModelEstimate& estimate) {
  std::vector<std::size_t> places{0, 1, 2, 3};
  if (estimate.speed_dependence) places.insert(places.end(), {4, 5});
  if (estimate.ageing) places.push_back(6);
  return places;
}

/// Standard errors of (ln k, ln w_n, zeta, ln dF) from those of the parameters; empty where one is null.
std::optional<std::vector<double>> parameter_errors(const JsonNode& parameters, const ModelEstimate& estimate) {
  const std::array<double, 4> scales{estimate.stiffness_N_per_m, estimate.natural_frequency_rad_per_s, 1.0,
                                     estimate.friction_difference_N};
  std::vector<double> errors;
  for (std::size_t i = 0; i < kNeeded.size(); ++i) {
    const std::optional<double> error = checked_error(parameters.member(key_of(kNeeded[i])).member("se"));
    if (!error) return std::nullopt;
    errors.push_back(*error / scales[i]);
  }
  return errors;
}

std::size_t row_of(const JsonNode& names, const std::string& name) {
  std::size_t row = 0;
  while (row < names.array_size() && names.element(row).text() != name) ++row;
  if (row == names.array_size()) names.fail("a list with " + name);
  return row;
}

/// Rows in the correlation's matrix.
std::vector<std::size_t> rows_of(const JsonNode& names, const std::vector<std::size_t>& places) {
  std::vector<std::size_t> rows;
  rows.reserve(places.size());
  for (const std::size_t place : places) rows.push_back(row_of(names, key_of(kModelParameters[place])));
  return rows;
}

double correlation_between(const JsonNode& matrix, std::size_t i, std::size_t j, std::size_t size) {
  const auto cell = [&](std::size_t row, std::size_t column) {
    const JsonNode cells = matrix.element(row);
    if (cells.array_size() != size) cells.fail(fmt::format("a row of {} numbers", size));
    const JsonNode node = cells.element(column);
    const std::optional<double> value = node.number("a number from -1 to 1");
    constexpr double kRounding = 1e-9;
    if (!value || std::abs(*value) > 1.0 + kRounding) node.fail("a number from -1 to 1");
    return *value;
  };
  constexpr double kAsymmetry = 1e-6;
  if (std::abs(cell(i, j) - cell(j, i)) > kAsymmetry) matrix.fail("a symmetric matrix");
  return i == j ? 1.0 : cell(i, j);
}

/// Those of the correlation, else those of the parameters; empty where one is null. (Slope and alpha may be told only
/// together, then the parameter has none.)
std::optional<std::vector<double>> standard_errors(const JsonNode& document, const ModelEstimate& estimate,
                                                   const std::vector<std::size_t>& rows) {
  const JsonNode correlation = document.member("correlation");
  const std::size_t size = correlation.member("names").array_size();
  const bool scaled = correlation.has("scaled_se") && correlation.member("scaled_se").array_size() == size;
  if (!estimate.speed_dependence && !estimate.ageing) {
    std::optional<std::vector<double>> errors = parameter_errors(document.member("parameters"), estimate);
    if (!errors || !scaled) return errors;
  }
  const JsonNode list = correlation.member("scaled_se");
  if (list.array_size() != size) list.fail(fmt::format("a list of {} numbers", size));
  std::vector<double> errors;
  for (const std::size_t row : rows) {
    const std::optional<double> error = checked_error(list.element(row));
    if (!error) return std::nullopt;
    errors.push_back(*error);
  }
  return errors;
}

/// From standard errors and correlation; leaves `model` without covariance where the document has none.
void read_covariance(const JsonNode& document, PredictionModel& model) {
  const std::optional<JsonNode> correlation = document.known("correlation");
  if (!correlation) return;
  const JsonNode names = correlation->member("names");
  const std::vector<std::size_t> places = places_of(model.estimate);
  const std::vector<std::size_t> rows = rows_of(names, places);
  const JsonNode matrix = correlation->member("matrix");
  const std::size_t size = names.array_size();
  if (matrix.array_size() != size) matrix.fail(fmt::format("{} rows", size));
  const std::optional<std::vector<double>> errors = standard_errors(document, model.estimate, rows);
  if (!errors) return;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      model.estimate.covariance[places[i]][places[j]] =
          (*errors)[i] * (*errors)[j] * correlation_between(matrix, rows[i], rows[j], size);
    }
  }
  model.has_covariance = true;
}

/// From the correlation: there it has a value also where the data tell it only together with others.
double working_value(const std::string& file, const JsonNode& document, const std::string& name) {
  const std::optional<JsonNode> correlation = document.known("correlation");
  if (!correlation) {
    cannot_predict(file, fmt::format("{} needs correlation (with its values), which is missing", name));
  }
  const JsonNode values = correlation->member("values");
  if (values.array_size() != correlation->member("names").array_size()) values.fail("as many numbers as names");
  const JsonNode node = values.element(row_of(correlation->member("names"), name));
  const std::optional<double> value = node.number("a number");
  if (!value) node.fail("a number");
  return *value;
}

std::optional<SpeedDependence> speed_dependence(const std::string& file, const JsonNode& document) {
  const auto tier = document.known("model", "tier");
  if (!tier || tier->text() != "velocity") return std::nullopt;
  return SpeedDependence{working_value(file, document, key_of(ParameterId::FrictionSlope)),
                         working_value(file, document, key_of(ParameterId::Alpha))};
}

std::optional<Ageing> ageing(const std::string& file, const JsonNode& document) {
  const auto stick_s = document.known("model", "ageing_reference_s");
  if (!stick_s) return std::nullopt;
  const double rate_N = working_value(file, document, key_of(ParameterId::Ageing));
  if (!(rate_N > 0.0)) cannot_predict(file, "ageing_N is not above 0");
  return Ageing{rate_N, stick_s->positive()};
}

std::optional<Estimate> kinetic_friction_N(const JsonNode& parameters) {
  const auto parameter = parameters.known("kinetic_friction_N");
  if (!parameter) return std::nullopt;
  const std::optional<double> value = parameter->member("value").number();
  if (!value || !is_known(parameter->member("status").text())) return std::nullopt;
  return Estimate{value, checked_error(parameter->member("se")), std::nullopt, {}};
}

/// Student's t; without the key, or null, the normal distribution.
double degrees_of_freedom(const JsonNode& document) {
  const auto freedom = document.known("model", "degrees_of_freedom");
  if (!freedom) return std::numeric_limits<double>::infinity();
  const double value = freedom->positive();
  if (!(value >= 1.0)) freedom->fail("a number >= 1 or null");
  return value;
}

// What stands around the parameters. Documents of earlier versions lack parts of it.

/// Of a sweep.
std::optional<SpeedReach> reach(const JsonNode& document) {
  const auto speeds = document.known("model", "speeds_m_per_s");
  if (!speeds) return std::nullopt;
  if (speeds->array_size() != 2) speeds->fail("[slowest, fastest]");
  SpeedReach reach{speeds->element(0).positive(), speeds->element(1).positive(), std::nullopt};
  if (reach.slowest_m_per_s > reach.fastest_m_per_s) speeds->fail("[slowest, fastest]");
  if (const auto trend = document.known("model", "trend_beyond")) reach.trend = checked_error(*trend);
  return reach;
}

std::optional<double> normal_force_N(const JsonNode& document) {
  const auto load = document.known("model", "normal_force_N");
  return load ? std::optional(load->positive()) : std::nullopt;
}

/// [speed or null, speed or null]
ObservedEnd observed_end(const JsonNode& document) {
  const auto ends = document.known("derived", "observed_end_m_per_s");
  if (!ends) return {};
  if (ends->array_size() != 2) ends->fail("[highest speed that sticks, lowest that does not]");
  return {checked_error(ends->element(0)), checked_error(ends->element(1))};
}

Warnings warnings(const JsonNode& document) {
  Warnings list;
  const auto nodes = document.known("warnings");
  for (std::size_t i = 0; nodes && i < nodes->array_size(); ++i) {
    const JsonNode warning = nodes->element(i);
    list.push_back({warning.member("code").text(), warning.member("message").text()});
  }
  return list;
}

std::vector<std::string> conditions(const JsonNode& document) {
  std::vector<std::string> texts;
  const auto list = document.known("model", "conditional_on");
  for (std::size_t i = 0; list && i < list->array_size(); ++i) texts.push_back(list->element(i).text());
  return texts;
}

}  // namespace

FitDocument fit_document_from(const JsonNode& document, const std::string& name) {
  if (const JsonNode schema = document.member("schema"); schema.text() != "slipfit.fit/1") schema.fail("slipfit.fit/1");
  if (!document.has("parameters")) {
    throw ThrownError(Error{"cannot_predict", fmt::format("'{}': has no parameters: slipfit analyze fits none, and fit "
                                                          "found no cycles; use slipfit fit on stick-slip",
                                                          name)});
  }
  const JsonNode parameters = document.member("parameters");
  check_known(name, parameters);
  FitDocument result;
  ModelEstimate& estimate = result.model.estimate;
  const std::array<double*, 4> targets{&estimate.stiffness_N_per_m, &estimate.natural_frequency_rad_per_s,
                                       &estimate.damping_ratio, &estimate.friction_difference_N};
  for (std::size_t i = 0; i < kNeeded.size(); ++i) {
    *targets[i] = checked_value(parameters.member(key_of(kNeeded[i])), kNeeded[i]);
  }
  estimate.speed_dependence = speed_dependence(name, document);
  estimate.ageing = ageing(name, document);
  estimate.damping_identified = damping_identified(parameters.member(key_of(ParameterId::DampingRatio)));
  estimate.degrees_of_freedom = degrees_of_freedom(document);
  read_covariance(document, result.model);
  result.model.kinetic_friction_N = kinetic_friction_N(parameters);
  estimate.reach = reach(document);
  estimate.normal_force_N = normal_force_N(document);
  result.model.observed_end = observed_end(document);
  result.conditional_on = conditions(document);
  result.warnings = warnings(document);
  return result;
}

}  // namespace slipfit::documents
