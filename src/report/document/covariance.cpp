#include "report/document/prediction_model.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

namespace slipfit::documents {
namespace {

/// Rows of ModelEstimate::covariance that the model has: the four, of friction that depends on the speed its slope and
/// rate, of static friction that ages its rate and, where `names` has it, its cut-off, of reloading both, the exponent
/// of k that goes with the speed.
std::vector<std::size_t> places_of(const ModelEstimate& estimate, const JsonNode& names) {
  using Id = ParameterId;
  std::vector<std::size_t> places;
  const auto add = [&places](Id id) { places.push_back(place_in_model(id)); };
  for (const Id id : kNeeded) add(id);
  if (estimate.speed_dependence) {
    add(Id::FrictionSlope);
    add(Id::Alpha);
  }
  if (estimate.ageing) add(Id::Ageing);
  if (estimate.ageing && find_row(names, key_of(Id::AgeingTime))) add(Id::AgeingTime);
  if (estimate.reloading) {
    add(Id::ReloadForce);
    add(Id::ReloadLength);
  }
  if (estimate.stiffness_trend) add(Id::StiffnessExponent);
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
  if (!estimate.speed_dependence && !estimate.ageing && !estimate.reloading && !estimate.stiffness_trend) {
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

}  // namespace

std::string key_of(ParameterId id) {
  return std::string(info(id).key);
}

std::optional<double> checked_error(const JsonNode& node) {
  const std::optional<double> error = node.number();
  if (error && !(*error >= 0.0)) node.fail("a number >= 0 or null");
  return error;
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
  const std::vector<std::size_t> places = places_of(model.estimate, names);
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

}  // namespace slipfit::documents
