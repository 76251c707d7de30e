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
