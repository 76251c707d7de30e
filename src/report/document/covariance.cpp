#include "report/document/prediction_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "report/document/check_document.hpp"

namespace slipfit::documents {
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
