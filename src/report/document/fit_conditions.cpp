#include "report/document/fit_conditions.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace slipfit::documents {
namespace {

RecordingPlan conditions_of(const JsonNode& recording) {
  return {recording.member("speed_m_per_s").positive(), recording.member("sample_rate_Hz").positive(),
          recording.member("duration_s").positive()};
}

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// A recording whose scatter is not known adds nothing.
void add_scatter(const JsonNode& cycles, std::vector<double>& scatter) {
  if (const std::optional<double> sd = cycles.member("force_drop_sd_N").number()) scatter.push_back(*sd);
}

}  // namespace

PlanBasis plan_basis_of(const JsonNode& document, ModelEstimate estimate) {
  PlanBasis result;
  result.estimate = std::move(estimate);
  std::vector<double> scatter;
  if (!document.has("recordings")) {
    result.recordings = {conditions_of(document.member("recording"))};
    result.noise_rms_N = document.member("model").member("residual").member("rms_N").positive();
    add_scatter(document.member("cycles"), scatter);
    result.force_drop_sd_N = median(scatter);
    return result;
  }
  const std::optional<bool> shared = document.member("model").member("level_shared").flag();
  if (shared.value_or(false)) result.levels = LevelSharing::Shared;
  const JsonNode members = document.member("recordings");
  std::vector<double> noise;
  for (std::size_t i = 0; i < members.array_size(); ++i) {
    const JsonNode member = members.element(i);
    if (member.member("role").text() != "cycles" || !member.has("joint")) continue;
    if (member.member("joint").member("rms_N").is_null()) continue;
    result.recordings.push_back(conditions_of(member.member("recording")));
    noise.push_back(member.member("joint").member("rms_N").positive());
    add_scatter(member.member("cycles"), scatter);
  }
  if (noise.empty()) members.fail("recordings with cycles in the joint fit");
  result.noise_rms_N = *median(noise);
  result.force_drop_sd_N = median(scatter);
  return result;
}

}  // namespace slipfit::documents
