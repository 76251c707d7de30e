#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "report/names.hpp"
#include "slipfit/analysis.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/report/json.hpp"

template <class Value>
struct nlohmann::adl_serializer<std::optional<Value>> {
  /// null where it is empty.
  static void to_json(nlohmann::ordered_json& json, const std::optional<Value>& value) {
    if (value) {
      json = *value;
    } else {
      json = nullptr;
    }
  }
};

namespace slipfit {

using Json = nlohmann::ordered_json;  // keys in the order of writing: same input, same bytes

// JSON conversions of the result types. A number that is not finite is null, as nlohmann::json makes it itself.

/// The name of the choice.
template <Named Choice>
void to_json(Json& json, Choice choice) {
  json = std::string(name_of(choice));
}
/// [low, high], or null where a bound is not finite.
void to_json(Json& json, const Interval& bounds);
/// { value, se, ci95 }, and a note where there is one.
void to_json(Json& json, const Estimate& quantity);
void to_json(Json& json, const Warning& warning);

/// A text, or null where it is empty.
inline Json text_or_null(const std::string& text) {
  return text.empty() ? Json() : Json(text);
}

/// [to_json(item), ...]
template <class Items, class ToJson>
Json array_of(const Items& items, ToJson to_json) {
  Json array = Json::array();
  for (const auto& item : items) array.push_back(to_json(item));
  return array;
}

/// Valid UTF-8, whatever the strings from outside hold.
std::string text_of(const Json& json, JsonLayout layout = JsonLayout::Indented);

/// The options of a fit as the user stated them.
Json options_json(const AskedFit& asked);

}  // namespace slipfit
