#include "report/document/prediction_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "report/document/check_document.hpp"
#include "report/document/json_node.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/predict/single_speed.hpp"

namespace slipfit::documents {

namespace {

bool is_known(const std::string& status) {
  return status == "identified" || status == "weak" || status == "fixed" || status == "conditional";
}

[[noreturn]] void cannot_predict(const std::string& name, const std::string& why) {
  throw ThrownError(Error{"cannot_predict", fmt::format("'{}': cannot predict: {}", printable(name), printable(why))});
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

/// Returns true if the user fixed zeta, or if its interval is above 0.
bool damping_identified(const JsonNode& damping) {
  if (damping.member("status").text() == "fixed") return true;
  const JsonNode bounds = damping.member("ci95");
  if (bounds.is_null()) return false;
  if (bounds.array_size() != 2) bounds.fail("[low, high] or null");
  const std::optional<double> low = bounds.element(0).number();
  return low && *low > 0.0;
}

/// Returns a value from the correlation, which also contains parameters that the data determine only together with
/// others.
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

/// Returns whether the model of the document has a parameter.
bool contains(const JsonNode& document, ParameterId id) {
  const std::optional<JsonNode> correlation = document.known("correlation");
  return correlation && find_row(correlation->member("names"), key_of(id));
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
  const double cutoff_s = contains(document, ParameterId::AgeingTime)
                              ? working_value(file, document, key_of(ParameterId::AgeingTime))
                              : 0.0;
  if (!(cutoff_s >= 0.0)) cannot_predict(file, "ageing_time_s is below 0");
  return Ageing{rate_N, stick_s->positive(), cutoff_s};
}

std::optional<Reloading> reloading(const std::string& file, const JsonNode& document) {
  if (!contains(document, ParameterId::ReloadForce)) return std::nullopt;
  const Reloading reloading{working_value(file, document, key_of(ParameterId::ReloadForce)),
                            working_value(file, document, key_of(ParameterId::ReloadLength))};
  if (!(reloading.force_N > 0.0)) cannot_predict(file, "reload_force_N is not above 0");
  if (!(reloading.length_m > 0.0)) cannot_predict(file, "reload_length_m is not above 0");
  return reloading;
}

std::optional<RelaxingSpring> relaxing(const std::string& file, const JsonNode& document) {
  if (!contains(document, ParameterId::Relaxation)) return std::nullopt;
  const RelaxingSpring relaxing{working_value(file, document, key_of(ParameterId::Relaxation)),
                                working_value(file, document, key_of(ParameterId::RelaxationTime))};
  if (!(relaxing.share >= 0.0 && relaxing.share < 1.0)) cannot_predict(file, "relaxation is not between 0 and 1");
  if (!(relaxing.time_s > 0.0)) cannot_predict(file, "relaxation_time_s is not above 0");
  return relaxing;
}

std::optional<StiffnessTrend> stiffness_trend(const std::string& file, const JsonNode& document) {
  const auto speed = document.known("model", "stiffness_speed_m_per_s");
  if (!speed) return std::nullopt;
  return StiffnessTrend{working_value(file, document, key_of(ParameterId::StiffnessExponent)), speed->positive()};
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

// The surroundings of the parameters. Documents of earlier versions lack parts of it.

/// Returns the speed range of a sweep.
std::optional<SpeedReach> reach(const JsonNode& document) {
  const auto speeds = document.known("model", "speeds_m_per_s");
  if (!speeds) return std::nullopt;
  if (speeds->array_size() != 2) speeds->fail("[slowest, fastest]");
  SpeedReach reach{speeds->element(0).positive(), speeds->element(1).positive(), std::nullopt};
  if (reach.slowest_m_per_s > reach.fastest_m_per_s) speeds->fail("[slowest, fastest]");
  if (const auto trend = document.known("model", "trend_beyond")) reach.trend = checked_error(*trend);
  return reach;
}

/// Adds the uncertainty at other speeds that a document of one recording leaves open.
ModelEstimate with_single_speed(ModelEstimate estimate, const JsonNode& document) {
  const auto speed = document.known("recording", "speed_m_per_s");
  if (!speed) return estimate;
  std::array<ParameterStatus, 4> statuses{};
  for (std::size_t i = 0; i < statuses.size(); ++i) {
    const std::string status = document.member("parameters").member(key_of(kNeeded[i])).member("status").text();
    statuses[i] = status == "identified"    ? ParameterStatus::Identified
                  : status == "fixed"       ? ParameterStatus::Fixed
                  : status == "conditional" ? ParameterStatus::Conditional
                                            : ParameterStatus::Weak;
  }
  return from_single_speed(estimate, speed->positive(), statuses);
}

/// The load that all recordings of a sweep state, or that of the one recording.
std::optional<double> normal_force_N(const JsonNode& document) {
  for (const char* const section : {"model", "recording"}) {
    if (const auto load = document.known(section, "normal_force_N")) return load->positive();
  }
  return std::nullopt;
}

/// [speed or null, speed or null]
ObservedEnd observed_end(const JsonNode& document) {
  const auto ends = document.known("derived", "observed_end_m_per_s");
  if (!ends) return {};
  if (ends->array_size() != 2) ends->fail("[highest speed that sticks, lowest that does not]");
  return {checked_error(ends->element(0)), checked_error(ends->element(1))};
}

std::vector<std::string> conditions(const JsonNode& document) {
  std::vector<std::string> texts;
  for (const JsonNode& condition : document.elements("model", "conditional_on")) texts.push_back(condition.text());
  return texts;
}

}  // namespace

FitDocument fit_document_from(const JsonNode& document, const std::string& name) {
  if (!document.has("parameters")) {
    throw ThrownError(Error{"cannot_predict", fmt::format("'{}': has no parameters: slipfit analyze fits none, and fit "
                                                          "found no cycles; use slipfit fit on stick-slip",
                                                          printable(name))});
  }
  const JsonNode parameters = document.member("parameters");
  check_known(name, parameters);
  FitDocument result;
  ModelEstimate& estimate = result.model.estimate;
  for (const ParameterId id : kNeeded) *estimate.find(id) = checked_value(parameters.member(key_of(id)), id);
  estimate.speed_dependence = speed_dependence(name, document);
  estimate.ageing = ageing(name, document);
  estimate.reloading = reloading(name, document);
  estimate.stiffness_trend = stiffness_trend(name, document);
  estimate.relaxing = relaxing(name, document);
  estimate.damping_identified = damping_identified(parameters.member(key_of(ParameterId::DampingRatio)));
  estimate.degrees_of_freedom = degrees_of_freedom(document);
  read_covariance(document, result.model);
  result.model.kinetic_friction_N = kinetic_friction_N(parameters);
  estimate.reach = reach(document);
  estimate = with_single_speed(estimate, document);
  estimate.normal_force_N = normal_force_N(document);
  result.model.observed_end = observed_end(document);
  result.conditional_on = conditions(document);
  result.warnings = warnings_in(document);
  return result;
}

namespace {

/// A coordinate of the model: its place in ModelEstimate::covariance, and its row in the correlation.
struct Row {
  std::size_t place = 0;
  std::size_t row = 0;
};

constexpr double kLargestLogError = 10.0;  // a factor of e^20 either way, of a parameter that is said to be known

/// Returns true if the model contains the logarithm of the parameter, which a prediction needs to know.
bool is_logarithmic(ParameterId id) {
  constexpr std::array kLogarithmic{ParameterId::Stiffness, ParameterId::NaturalFrequency,
                                    ParameterId::FrictionDifference};
  return std::ranges::find(kLogarithmic, id) != kLogarithmic.end();
}

/// The four, and what else the fit has.
std::vector<Row> rows_of(const JsonNode& names) {
  std::vector<Row> rows;
  for (std::size_t place = 0; place < kModelParameters.size(); ++place) {
    const std::string name = key_of(kModelParameters[place]);
    const std::optional<std::size_t> row = place < kNeeded.size() ? row_of(names, name) : find_row(names, name);
    if (row) rows.push_back({place, *row});
  }
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

/// Returns the standard errors, or nothing if one is null: in the list or, for a model of only four parameters, in the
/// parameters.
std::optional<std::vector<double>> standard_errors(const JsonNode& document, const std::vector<Row>& rows,
                                                   std::size_t size) {
  const JsonNode list = document.member("correlation").member("scaled_se");
  if (list.array_size() != size) list.fail(fmt::format("a list of {} numbers", size));
  std::vector<double> errors;
  for (const Row& row : rows) {
    const bool is_of_four = rows.size() == kNeeded.size();
    const auto known = [&] { return document.member("parameters").member(key_of(kModelParameters[row.place])); };
    const JsonNode node = list.element(row.row);
    const std::optional<double> error = checked_error(node);
    if (error && is_logarithmic(kModelParameters[row.place]) && *error > kLargestLogError) {
      node.fail(fmt::format("a standard error of a logarithm, at most {}", kLargestLogError));
    }
    if (!error || (is_of_four && !checked_error(known().member("se")))) return std::nullopt;
    errors.push_back(*error);
  }
  return errors;
}

}  // namespace

std::string key_of(ParameterId id) {
  return std::string(info(id).key);
}

std::optional<std::size_t> find_row(const JsonNode& names, const std::string& name) {
  for (std::size_t row = 0; row < names.array_size(); ++row) {
    if (names.element(row).text() == name) return row;
  }
  return std::nullopt;
}

std::size_t row_of(const JsonNode& names, const std::string& name) {
  const std::optional<std::size_t> row = find_row(names, name);
  if (!row) names.fail("a list with " + name);
  return *row;
}

void read_covariance(const JsonNode& document, PredictionModel& model) {
  const std::optional<JsonNode> correlation = document.known("correlation");
  if (!correlation) return;
  const JsonNode names = correlation->member("names");
  const std::vector<Row> rows = rows_of(names);
  const JsonNode matrix = correlation->member("matrix");
  const std::size_t size = names.array_size();
  if (matrix.array_size() != size) matrix.fail(fmt::format("{} rows", size));
  const std::optional<std::vector<double>> errors = standard_errors(document, rows, size);
  if (!errors) return;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      model.estimate.covariance[rows[i].place][rows[j].place] =
          (*errors)[i] * (*errors)[j] * correlation_between(matrix, rows[i].row, rows[j].row, size);
    }
  }
  model.has_covariance = true;
}

}  // namespace slipfit::documents
