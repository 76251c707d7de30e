#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "slipfit/analysis.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/result.hpp"
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

// What nlohmann::json makes of our types. A number that is not finite is null, as it makes it itself.

/// [low, high], or null where a bound is not finite.
void to_json(Json& json, const Interval& bounds);
/// { value, se, ci95 }, and a note where there is one.
void to_json(Json& json, const Estimate& quantity);
void to_json(Json& json, const Warning& warning);

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
/// numbers are in the object "coefficient" instead.
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

/// An effect that the model of a fit includes besides stick-slip itself, with what is known of it.
struct ModelTerm {
  std::string_view code;  ///< where a warning reports the effect, too, that of the warning
  std::vector<ParameterId> parameters;
  std::string text;
};

/// Returns the effects in the model of a fit.
std::vector<ModelTerm> model_terms(const FitResult& fit);

// One function a section of the document (docs/formats.md).
Json options_json(const AskedFit& asked);
Json recording_json(const Recording& recording, const Analysis& analysis);
Json frequency_json(const FrequencyReport& frequency);
Json cycles_json(const CycleStatistics& cycles, ForceQuantity quantity);
Json model_json(const FitResult& fit, ForceQuantity quantity);
Json parameters_json(const FitResult& fit);
Json correlation_json(const FitResult& fit);
Json level_trend_json(const LevelTrend& trend, ForceQuantity quantity);
Json audit_json(const std::vector<AuditPair>& pairs);
Json tests_json(const std::vector<ShortTest>& tests);
Json derived_json(const Derived& derived);
Json coefficients_json(const std::optional<Coefficients>& coefficients);
Json transients_json(const Transients& transients, ForceQuantity quantity);

}  // namespace slipfit
