#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/report/json.hpp"

namespace slipfit {

using Json = nlohmann::ordered_json;  // keys in the order of writing: same input, same bytes

/// null where the number is absent or not finite.
Json number(std::optional<double> value);

/// [low, high], or null where it is absent or a bound is not finite.
Json interval(const std::optional<Interval>& bounds);

/// { value, se, ci95 }, and a note where there is one.
Json estimate(const Estimate& quantity);

// Documents come from files: what is absent, or of another kind, is null or empty.
Json child(const Json& json, const std::string& key);
std::string text_in(const Json& json, const std::string& key);
std::optional<double> number_in(const Json& json, const std::string& key);
/// { value, se, ci95 }, the keys with this behind them.
Estimate estimate_in(const Json& json, const std::string& suffix = {});

/// [to_json(item), ...]
template <class Items, class ToJson>
Json array_of(const Items& items, ToJson to_json) {
  Json array = Json::array();
  for (const auto& item : items) array.push_back(to_json(item));
  return array;
}

/// Valid UTF-8, whatever the strings from outside hold.
std::string text_of(const Json& json, JsonLayout layout = JsonLayout::Indented);

/// Numbers in the unit of the force column. The keys NAME_N hold newtons and are null for a friction coefficient, whose
/// numbers stand in the object "coefficient" instead.
class ForceKeys {
 public:
  ForceKeys(Json& object, ForceQuantity quantity) : object_(object), quantity_(quantity) {}
  void put(const std::string& name, std::optional<double> value);
  void finish();

 private:
  Json& object_;
  ForceQuantity quantity_;
  Json coefficient_ = Json::object();
};

}  // namespace slipfit
