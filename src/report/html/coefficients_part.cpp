#include <fmt/format.h>

#include "report/html/markup.hpp"
#include "report/html/page.hpp"
#include "report/quantities.hpp"

namespace slipfit::html {
namespace {

std::vector<std::string> row_of(std::string_view words, const Estimate& estimate) {
  const EstimateRow shown = estimate_row(estimate, std::string());
  return {text(words), text(shown.value), shown.interval.empty() ? "-" : text(shown.interval),
          formula_text(estimate.note)};
}

}  // namespace

std::string coefficients_part(const Source& source) {
  const auto& coefficients = source.analysis.coefficients;
  if (!coefficients) return {};
  std::vector<std::vector<std::string>> rows;
  for (const auto& [words, estimate] : coefficient_rows(*coefficients)) rows.push_back(row_of(words, estimate));
  for (const StandardCoefficients& standard : coefficients->standards) {
    Estimate kinetic = standard.kinetic_coefficient;
    kinetic.note = standard.standard + " prescribes " + standard.prescribes + ". Here: " + differences_text(standard);
    rows.push_back(row_of("static, as " + standard.standard, standard.static_coefficient));
    rows.push_back(row_of("kinetic, as " + standard.standard, kinetic));
  }
  return section(" id=\"coefficients\" class=\"flows\"", "Coefficient of friction",
                 table(" class=\"parameters\"", {"", "#value", "~95 % interval", "what it is"}, rows));
}

}  // namespace slipfit::html
