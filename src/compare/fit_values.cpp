#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/unknown.hpp"
#include "report/json_values.hpp"
#include "report/quantities.hpp"
#include "slipfit/compare.hpp"
#include "slipfit/fit/parameter.hpp"

namespace slipfit {
namespace {

std::vector<ComparedQuantity> make_quantities() {
  std::vector<ComparedQuantity> quantities;
  for (const ParameterInfo& parameter : parameter_table()) {
    if (parameter.id == ParameterId::SensorAverage) continue;  // of the instrument
    quantities.push_back(
        {"parameters", std::string(parameter.key), std::string(parameter.words), std::string(parameter.unit)});
  }
  quantities.push_back({"frequency", "frequency_Hz", "frequency of the slips", "Hz"});
  const auto& spacing = kMeasured.front();  // the other is its inverse
  quantities.push_back({"derived", std::string(spacing.key), std::string(spacing.words), std::string(spacing.unit)});
  for (const auto& row : kCoefficients) {
    quantities.push_back({"coefficients", std::string(row.key),
                          "coefficient of friction (" + std::string(row.words) + ")", std::string(row.unit)});
  }
  return quantities;
}

/// What is only an interval, or was not measured, cannot be compared.
ComparedValue value_of(const Json& json, const std::string& suffix) {
  ComparedValue value{estimate_in(json, suffix), text_in(json, "status"), !json.is_object()};
  Estimate& estimate = value.estimate;
  if (value.status == "bounded") {
    estimate = {{}, {}, estimate.ci95, "only its interval is known (status bounded)"};
  } else if (value.status == "fixed") {
    estimate = unknown("held at a stated value (status fixed)");
  } else if (!estimate.value) {
    const char* const why = value.is_absent ? "its result does not hold it" : "not known";
    estimate = unknown(estimate.note.empty() ? std::string(why) : estimate.note);
  }
  return value;
}

ComparedValue value_in(const Json& document, const ComparedQuantity& quantity) {
  if (quantity.section == "frequency") return value_of(child(document, "frequency"), "_Hz");
  return value_of(child(child(document, quantity.section), quantity.key), {});
}

}  // namespace

std::span<const ComparedQuantity> compared_quantities() {
  static const std::vector<ComparedQuantity> quantities = make_quantities();
  return quantities;
}

Result<ComparedFit> compared_fit(const std::string& document) {
  const Json json = Json::parse(document, nullptr, false);
  if (text_in(json, "schema") != "slipfit.fit/1") {
    return Error{"bad_document",
                 fmt::format("'{}': no fit document, expected what slipfit fit --json writes", document.substr(0, 60))};
  }
  const Json recording = child(json, "recording");
  ComparedFit fit;
  fit.id = text_in(json, "id");
  fit.file = text_in(recording, "file");
  const Json digest = child(recording, "input_digest");
  if (digest.is_string()) fit.source = digest.get<std::string>() + child(recording, "sliding_s").dump();
  fit.group = text_in(recording, "group");
  fit.motion = text_in(json, "status");
  fit.speed_m_per_s = number_in(recording, "speed_m_per_s");
  fit.normal_force_N = number_in(recording, "normal_force_N");
  for (const ComparedQuantity& quantity : compared_quantities()) fit.values.push_back(value_in(json, quantity));
  return fit;
}

}  // namespace slipfit
