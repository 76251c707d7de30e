#include "slipfit/report/plan.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

#include "report/blocks.hpp"
#include "report/format.hpp"
#include "report/json_values.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/report/quantities.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {
namespace {

/// In the order of Limit.
struct LimitWords {
  std::string_view name;
  std::string_view words;
};
constexpr std::array<LimitWords, 6> kLimits{
    {{"noise", "noise of the samples: more cycles, or a quieter sensor"},
     {"scatter", "scatter of the static friction: more cycles"},
     {"sampling", "too few samples in a slip: a faster clock"},
     {"cycles", "noise and scatter: more cycles"},
     {"misfit", "systematic differences: cycles or recordings disagree with the model"},
     {"held", "held, by --fix or because the recordings do not determine it"}}};

const LimitWords& words_of(Limit limit) {
  return kLimits.at(static_cast<std::size_t>(limit));
}

std::string percent(double part, double whole) {
  if (!std::isfinite(part) || !std::isfinite(whole)) return "-";
  // Of a value at 0 (zeta at its bound) the error itself.
  if (whole == 0.0) return rounded(part, part);
  const double share = 100.0 * part / std::abs(whole);
  return rounded(share, share) + " %";
}

std::string options_text(const Plan& plan, const PredictionSource& source) {
  if (plan.options.empty()) return "\nNo speed near those measured gives enough cycles in the same time.\n";
  Table table({Align::Right, Align::Right, Align::Right, Align::Right, Align::Right, Align::Right});
  table.add({"speed", "sample rate", "duration", "cycles", "samples per slip", "standard error then"});
  for (const PlanOption& option : plan.options) {
    table.add(
        {quantity_text(option.recording.speed_m_per_s, speed_unit(source.speed_unit, option.recording.speed_m_per_s)),
         quantity_text(option.recording.sample_rate_Hz, "Hz"), quantity_text(option.recording.duration_s, "s"),
         fmt::format("{:.0f}", option.cycles), fmt::format("{:.1f}", option.samples_per_slip),
         percent(option.standard_error, plan.value)});
  }
  std::string text = "\nOne additional recording, as long as the previous ones (best first)\n" + table.text();
  if (!plan.halving_s)
    return text + "  no reasonable duration at the first of these speeds would halve the standard error\n";
  return text + fmt::format("  {} at the first of these speeds would halve the standard error\n",
                            quantity_text(*plan.halving_s, "s"));
}

std::string limits_text(const Plan& plan) {
  Table table({Align::Left, Align::Right, Align::Left});
  table.add({"parameter", "standard error", "limited by"});
  for (const ParameterLimit& limit : plan.limits) {
    table.add({std::string(quantity_with_key(limit.name).words), percent(limit.standard_error, limit.value),
               std::string(words_of(limit.limit).words)});
  }
  return "\nLimits of each parameter\n" + table.text();
}

Json option_json(const PlanOption& option) {
  return {{"speed_m_per_s", option.recording.speed_m_per_s}, {"sample_rate_Hz", option.recording.sample_rate_Hz},
          {"duration_s", option.recording.duration_s},       {"cycles", option.cycles},
          {"samples_per_slip", option.samples_per_slip},     {"se", option.standard_error}};
}

Json limit_json(const ParameterLimit& limit) {
  return {{"name", limit.name},
          {"value", limit.value},
          {"se", limit.standard_error},
          {"explained_se", limit.explained_error},
          {"limited_by", words_of(limit.limit).name}};
}

}  // namespace

std::string to_json(const Plan& plan, const PredictionSource& source) {
  const Json json{{"schema", "slipfit.plan/1"},
                  {"version", SLIPFIT_VERSION},
                  {"source", source.name},
                  {"conditional_on", source.conditional_on},
                  {"target",
                   {{"name", plan.target.name},
                    {"speed_m_per_s", plan.target.speed_m_per_s},
                    {"value", plan.value},
                    {"se", plan.standard_error}}},
                  {"options", array_of(plan.options, option_json)},
                  {"halving_s", plan.halving_s},
                  {"limits", array_of(plan.limits, limit_json)}};
  return text_of(json);
}

std::string to_text(const Plan& plan, const PredictionSource& source) {
  std::string text = fmt::format("To improve the {}", quantity_with_key(plan.target.name).words);
  if (plan.target.speed_m_per_s)
    text +=
        " at " + quantity_text(*plan.target.speed_m_per_s, speed_unit(source.speed_unit, plan.target.speed_m_per_s));
  text += fmt::format(", known to {} (standard error) from {}\n", percent(plan.standard_error, plan.value),
                      printable(source.name));
  return text + conditions_text(source.conditional_on) + options_text(plan, source) + limits_text(plan);
}

}  // namespace slipfit
