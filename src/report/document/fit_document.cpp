#include "slipfit/report/fit_document.hpp"

#include <fmt/format.h>

#include <utility>

#include "core/statistics.hpp"
#include "report/document/check_document.hpp"
#include "report/document/json_node.hpp"
#include "report/document/prediction_model.hpp"
#include "slipfit/core/printable.hpp"

namespace slipfit {
namespace {

using documents::JsonNode;

constexpr double kMostSamples = 1e9;            // of a recording: more than any file that is read
constexpr std::size_t kMostRecordings = 10000;  // of a sweep: a plan takes milliseconds for each

using documents::with_document;

RecordingPlan plan_of(const JsonNode& recording) {
  const RecordingPlan made{recording.member("speed_m_per_s").positive(), recording.member("sample_rate_Hz").positive(),
                           recording.member("duration_s").positive()};
  if (made.sample_rate_Hz * made.duration_s > kMostSamples) {
    recording.member("sample_rate_Hz").fail(fmt::format("at most {:g} samples in {} s", kMostSamples, made.duration_s));
  }
  return made;
}

/// The model, how the recordings with cycles were made, their noise and scatter (medians). Throws also where the
/// document has no residual in newtons.
PlanBasis plan_basis_of(const JsonNode& document, const ModelEstimate& estimate) {
  PlanBasis result;
  result.estimate = estimate;
  if (!document.has("recordings")) {
    result.recordings = {plan_of(document.member("recording"))};
    result.noise_rms_N = document.member("model").member("residual").member("rms_N").positive();
    result.force_drop_sd_N = document.member("cycles").member("force_drop_sd_N").number();
    return result;
  }
  const std::optional<bool> shared = document.member("model").member("level_shared").flag();
  if (shared.value_or(false)) result.levels = LevelSharing::Shared;
  const JsonNode members = document.member("recordings");
  if (members.array_size() > kMostRecordings) members.fail(fmt::format("at most {} recordings", kMostRecordings));
  std::vector<double> noise;
  std::vector<double> scatter;
  for (std::size_t i = 0; i < members.array_size(); ++i) {
    const JsonNode member = members.element(i);
    if (member.member("role").text() != "cycles" || !member.has("joint")) continue;
    if (member.member("joint").member("rms_N").is_null()) continue;
    result.recordings.push_back(plan_of(member.member("recording")));
    noise.push_back(member.member("joint").member("rms_N").positive());
    const std::optional<double> sd = member.member("cycles").member("force_drop_sd_N").number();
    if (sd) scatter.push_back(*sd);
  }
  if (noise.empty()) members.fail("recordings with cycles in the joint fit");
  result.noise_rms_N = median(noise);
  if (!scatter.empty()) result.force_drop_sd_N = median(scatter);
  return result;
}

PlanBasis plan_basis_from(const JsonNode& document, const std::string& name) {
  const FitDocument fit = documents::fit_document_from(document, name);
  if (!fit.model.has_covariance) {
    throw ThrownError(
        Error{"no_covariance",
              fmt::format("{}: has no covariance, which a plan needs: fit its recordings again with slipfit fit --json",
                          printable(name))});
  }
  return plan_basis_of(document, fit.model.estimate);
}

}  // namespace

std::optional<Error> check_fit_document(const std::string& content, const std::string& name) {
  const auto checked = with_document<bool>(content, name, [](const JsonNode&) { return true; });
  return checked ? std::nullopt : std::optional(checked.error());
}

Result<FitDocument> read_fit_document(const std::string& content, const std::string& name) {
  return with_document<FitDocument>(
      content, name, [&](const JsonNode& document) { return documents::fit_document_from(document, name); });
}

Result<FitDocument> at_load(FitDocument document, double normal_force_N, const std::string& name) {
  if (!document.model.estimate.normal_force_N) {
    return Error{"no_normal_force",
                 fmt::format("--normal-force: the recordings of '{}' state no normal force; fit them again with "
                             "--normal-force or the manifest's normal_force_N",
                             printable(name))};
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
