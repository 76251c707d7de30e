#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/result.hpp"
#include "slipfit/predict/plan.hpp"
#include "slipfit/predict/prediction.hpp"

namespace slipfit {

inline constexpr std::size_t kLargestFitDocument = std::size_t{64} << 20U;  ///< bytes: a thousand times a usual one

/// Returns the defect of a document of the schema slipfit.fit/1 that would mislead its reader, if any: too large or
/// nested too deeply, not JSON, an unknown status, a number out of its range, a negative standard error, a value
/// outside its interval. Messages call the document `name`, its file or its id. Error: bad_document.
std::optional<Error> check_fit_document(const std::string& content, const std::string& name);

/// The parts of a document of the schema slipfit.fit/1 that a prediction needs.
struct FitDocument {
  PredictionModel model;
  std::vector<std::string> conditional_on;
  Warnings warnings;
  std::string speed_unit;  ///< that the speed of its (first) recording was given in; empty: m/s
};

/// Reads a fit document. Errors: those of check_fit_document, cannot_predict (it leaves a parameter open on which the
/// motion depends).
Result<FitDocument> read_fit_document(const std::string& content, const std::string& name);

/// Returns the document under another normal force, which `conditional_on` states; `name` as above. Error:
/// no_normal_force (its recordings state none).
Result<FitDocument> at_load(FitDocument document, double normal_force_N, const std::string& name);

/// Reads the starting point of a plan: the model, and the conditions of the recordings with cycles. Errors: those of
/// read_fit_document, no_covariance; bad_document also if it has no residual in newtons.
Result<PlanBasis> read_plan_basis(const std::string& content, const std::string& name);

}  // namespace slipfit
