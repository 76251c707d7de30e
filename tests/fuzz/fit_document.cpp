// Bytes as the FIT.json of slipfit predict and plan: an answer in JSON, or a Failure of one line.
#include <array>
#include <nlohmann/json.hpp>

#include "demand.hpp"
#include "failure.hpp"
#include "fit_document.hpp"
#include "memory_file.hpp"
#include "slipfit/report/plan.hpp"
#include "slipfit/report/prediction.hpp"

namespace {

void predict_and_plan(const std::string& file) {
  const FitDocument document = read_fit_document(file);
  const slipfit::PredictionSource source{file, document.conditional_on};
  constexpr std::array<double, 3> kSpeeds_m_per_s{1e-4, 0.01, 1.0};
  const slipfit::Prediction prediction = slipfit::predict_at(document.model, kSpeeds_m_per_s);
  fuzz::demand(nlohmann::json::accept(slipfit::to_json(prediction, source)), "a prediction is JSON");
  (void)slipfit::to_text(prediction, source);
  (void)slipfit::prediction_to_csv(prediction);
  if (!document.model.has_covariance) return;
  RecordedConditions recorded = read_recorded_conditions(file);
  const auto plan = slipfit::plan_next({document.model.estimate, std::move(recorded.recordings), recorded.noise_rms_N,
                                        recorded.force_drop_sd_N, recorded.levels},
                                       std::nullopt);
  if (!plan) return fuzz::demand_readable(plan.error());
  fuzz::demand(nlohmann::json::accept(slipfit::to_json(plan.value(), source)), "a plan is JSON");
  (void)slipfit::to_text(plan.value(), source);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  try {
    predict_and_plan(file.name());
  } catch (const Failure& failure) {
    fuzz::demand(failure.exit() == ExitCode::WrongUsage, "a bad document is wrong usage");
  }
  return 0;
}
