#include "report/json_values.hpp"

#include "slipfit/core/printable.hpp"
#include "slipfit/core/range.hpp"

namespace slipfit {

void to_json(Json& json, const Interval& bounds) {
  if (is_finite(bounds.low) && is_finite(bounds.high)) json = {bounds.low, bounds.high};
}

void to_json(Json& json, const Estimate& quantity) {
  json = {{"value", quantity.value}, {"se", quantity.standard_error}, {"ci95", quantity.ci95}};
  if (!quantity.note.empty()) json["note"] = quantity.note;
}

void to_json(Json& json, const Warning& warning) {
  json = {{"code", warning.code}, {"message", warning.message}};
}

Json child(const Json& json, const std::string& key) {
  const auto found = json.find(key);
  return found == json.end() ? Json() : *found;
}

std::string text_in(const Json& json, const std::string& key) {
  const Json found = child(json, key);
  return found.is_string() ? found.get<std::string>() : std::string();
}

std::optional<double> number_in(const Json& json, const std::string& key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

Estimate estimate_in(const Json& json, const std::string& suffix) {
  Estimate estimate{number_in(json, "value" + suffix), number_in(json, "se" + suffix), {}, text_in(json, "note")};
  const Json bounds = child(json, "ci95" + suffix);
  if (bounds.is_array() && bounds.size() == 2 && bounds[0].is_number() && bounds[1].is_number()) {
    estimate.ci95 = Interval{bounds[0].get<double>(), bounds[1].get<double>()};
  }
  return estimate;
}

std::string text_of(const Json& json, JsonLayout layout) {
  const int indent = layout == JsonLayout::Indented ? 2 : -1;
  return printable_lines(json.dump(indent, ' ', false, Json::error_handler_t::replace));
}

void ForceKeys::put(const std::string& name, std::optional<double> value) {
  if (quantity_ == ForceQuantity::Force_N) {
    object_[name + "_N"] = value;
  } else {
    object_[name + "_N"] = nullptr;
    coefficient_[name] = value;
  }
}

void ForceKeys::finish() {
  if (quantity_ == ForceQuantity::FrictionCoefficient) object_["coefficient"] = std::move(coefficient_);
}

}  // namespace slipfit
