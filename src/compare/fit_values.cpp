#include <string>
#include <vector>

#include "core/unknown.hpp"
#include "report/document/check_document.hpp"
#include "report/document/document_values.hpp"
#include "report/quantities.hpp"
#include "slipfit/compare.hpp"

namespace slipfit {
namespace {

using documents::JsonNode;

std::vector<ComparedQuantity> make_quantities() {
  std::vector<ComparedQuantity> quantities;
  const auto add = [&quantities](const Quantity& quantity) {
    quantities.push_back(
        {std::string(quantity.section), std::string(quantity.key), full_words(quantity), std::string(quantity.unit)});
  };
  for (const Quantity& quantity : recording_quantities()) {
    if (quantity.section == "parameters" && quantity.key != info(ParameterId::SensorAverage).key) add(quantity);
  }
  add(kFrequency);
  add(kMeasured.front());  // the others are its inverse and its spread
  for (const Quantity& quantity : kCoefficients) add(quantity);
  return quantities;
}

/// Returns a value for the comparison; values that are only bounded or were not measured have none.
ComparedValue value_in(const JsonNode& document, const ComparedQuantity& quantity) {
  const auto found = documents::quantity_in(document, quantity_with_key(quantity.key));
  if (!found) return {unknown("its result does not contain it"), {}, true};
  ComparedValue value{found->estimate, found->status, false};
  Estimate& estimate = value.estimate;
  if (value.status == "bounded") {
    estimate = {{}, {}, estimate.ci95, "only its interval is known (status bounded)"};
  } else if (value.status == "fixed") {
    estimate = unknown("fixed at a stated value (status fixed)");
  } else if (!estimate.value) {
    estimate = unknown(estimate.note.empty() ? "not known" : estimate.note);
  }
  return value;
}

ComparedFit fit_from(const JsonNode& document) {
  ComparedFit fit;
  fit.id = document.text_at("id");
  fit.motion = document.text_at("status");
  if (const auto recording = document.known("recording")) {
    fit.file = recording->text_at("file");
    fit.source = recording->text_at("input_digest");
    const auto slides = recording->known("sliding_s");
    if (!fit.source.empty()) fit.source += slides ? slides->json_text() : "null";
    fit.group = recording->text_at("group");
    fit.speed_m_per_s = recording->number_at("speed_m_per_s");
    fit.normal_force_N = recording->number_at("normal_force_N");
  }
  for (const ComparedQuantity& quantity : compared_quantities()) fit.values.push_back(value_in(document, quantity));
  return fit;
}

}  // namespace

std::span<const ComparedQuantity> compared_quantities() {
  static const std::vector<ComparedQuantity> quantities = make_quantities();
  return quantities;
}

Result<ComparedFit> compared_fit(const std::string& document, const std::string& name) {
  return documents::with_document<ComparedFit>(document, name, fit_from);
}

}  // namespace slipfit
