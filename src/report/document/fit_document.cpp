#include "slipfit/report/fit_document.hpp"

#include <fmt/format.h>

#include <utility>

#include "report/document/fit_conditions.hpp"
#include "report/document/json_node.hpp"
#include "report/document/prediction_model.hpp"

namespace slipfit {
namespace {

using documents::BadDocument;
using documents::JsonNode;

/// The result of `read(document)`, or what it refused.
template <class Value, class Read>
Result<Value> with_document(const std::string& content, const std::string& name, const Read& read) {
  try {
    const nlohmann::json json = documents::parse_document(content, name);
    return read(JsonNode(name, json));
  } catch (const BadDocument& refused) {
    return refused.error();
  }
}

PlanBasis plan_basis_from(const JsonNode& document, const std::string& name) {
  const FitDocument fit = documents::fit_document_from(document, name);
  if (!fit.model.has_covariance) {
    throw BadDocument(
        Error{"no_covariance", fmt::format("{}: has no covariance, and without one there is nothing to narrow", name)});
  }
  return documents::plan_basis_of(document, fit.model.estimate);
}

}  // namespace

Result<FitDocument> read_fit_document(const std::string& content, const std::string& name) {
  return with_document<FitDocument>(
      content, name, [&](const JsonNode& document) { return documents::fit_document_from(document, name); });
}

Result<FitDocument> at_load(FitDocument document, double normal_force_N, const std::string& name) {
  if (!document.model.estimate.normal_force_N) {
    return Error{"no_normal_force",
                 fmt::format("--normal-force: the recordings of '{}' state no normal force; fit them again with "
                             "--normal-force or the manifest's normal_force_N",
                             name)};
  }
  document.model = at_load(std::move(document.model), normal_force_N);
  document.conditional_on.push_back(
      fmt::format("friction in proportion to the normal force, here {:.6g} N", normal_force_N));
  return document;
}

Result<PlanBasis> read_plan_basis(const std::string& content, const std::string& name) {
  return with_document<PlanBasis>(content, name,
                                  [&](const JsonNode& document) { return plan_basis_from(document, name); });
}

}  // namespace slipfit
