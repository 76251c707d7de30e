#include "report/model_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "report/format.hpp"

namespace slipfit {
namespace {

using Id = ParameterId;

struct TermRow {
  std::string_view code;
  std::array<Id, 2> parameters;  ///< twice the same: one; the first is the one of the text
  std::string_view words;
};

constexpr auto kTerms = std::to_array<TermRow>({
    {"samples_averaged", {Id::SensorAverage, Id::SensorAverage}, "sensor averaging over"},
    {"slip_weakening", {Id::SlipDistance, Id::SlipDistance}, "friction that weakens over a slip distance of"},
    {"force_recovery", {Id::ReloadForce, Id::ReloadLength}, "force recovery after a slip of"},
    {"relaxing_spring", {Id::Relaxation, Id::RelaxationTime}, "a spring that relaxes by a share of"},
    {"stiffness_goes_with_speed", {Id::StiffnessExponent, Id::StiffnessExponent}, "k proportional to V to the power"},
    {"static_friction_ages", {Id::Ageing, Id::AgeingTime}, "static friction that ages at a rate of"},
});

}  // namespace

std::vector<ModelTerm> model_terms(const FitResult& fit) {
  std::vector<ModelTerm> terms;
  for (const TermRow& row : kTerms) {
    const Parameter* const first = fit.find(row.parameters.front());
    if (first == nullptr || !first->estimate.value) continue;
    const EstimateRow shown = estimate_row(first->estimate, std::string(info(first->id).unit));
    ModelTerm term{row.code, {}, {}};
    for (const Id id : row.parameters) {
      if (fit.find(id) != nullptr && std::ranges::find(term.parameters, id) == term.parameters.end()) {
        term.parameters.push_back(id);
      }
    }
    term.text =
        fmt::format("{} {}{}", row.words, value_text(shown), shown.interval.empty() ? "" : " " + shown.interval);
    terms.push_back(std::move(term));
  }
  for (const Warning& warning : fit.warnings) {
    if (warning.code == "hum_fitted") terms.push_back({"hum_fitted", {}, warning.message});
  }
  return terms;
}

}  // namespace slipfit
