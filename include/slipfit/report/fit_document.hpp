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

/// What is wrong with a document of the schema slipfit.fit/1 that would mislead who reads it, if anything: too large or
/// nested too deeply, not JSON, an unknown status, a number out of its range, a negative standard error, a value
/// outside its interval. `name`: what messages call the document, its file or its id. Error: bad_document.
std::optional<Error> check_fit_document(const std::string& content, const std::string& name);

/// What a prediction needs of a document of the schema slipfit.fit/1.
struct FitDocument {
  PredictionModel model;
  std::vector<std::string> conditional_on;
  Warnings warnings;
};

/// Errors: those of check_fit_document, cannot_predict (it leaves a parameter open that the motion depends on).
Result<FitDocument> read_fit_document(const std::string& content, const std::string& name);

/// The same under another normal force, which is said in `conditional_on`; `name` as above. Error: no_normal_force (its
/// recordings state none).
Result<FitDocument> at_load(FitDocument document, double normal_force_N, const std::string& name);

/// What a plan starts from: the model, and how the recordings with cycles were made. Errors: those of
/// read_fit_document, no_covariance; bad_document also where it has no residual in newtons.
Result<PlanBasis> read_plan_basis(const std::string& content, const std::string& name);

}  // namespace slipfit
