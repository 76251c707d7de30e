#include "report/document/check_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "report/names.hpp"
#include "slipfit/core/range.hpp"
#include "slipfit/fit/parameter.hpp"

namespace slipfit::documents {
namespace {

/// Refuses a text that is not the name of a choice.
template <class Choice>
void check_name(const JsonNode& node) {
  if (!with_name<Choice>(node.text())) node.fail(fmt::format("one of {}", fmt::join(kNames<Choice>, ", ")));
}

/// The interval, and the value next to it whose key has the same ending (value_Hz and ci95_Hz).
void check_interval(const JsonNode& estimate, const JsonNode& interval, const std::string& ending) {
  if (interval.is_null()) return;
  const std::string expected = "[low, high] with low <= high, or null";
  const std::vector<JsonNode> ends = interval.elements(2, expected);
  const std::optional<double> low = ends[0].number();
  const std::optional<double> high = ends[1].number();
  if (!low || !high || !(*low <= *high)) interval.fail(expected);
  const std::optional<JsonNode> node = estimate.known("value" + ending);
  const std::optional<double> value = node ? node->number() : std::nullopt;
  if (value && !(*low <= *value && *value <= *high)) {
    node->fail(fmt::format("a number of its interval, {} to {}", *low, *high));
  }
}

/// The numbers of a value and of all that it holds.
void check_numbers(const JsonNode& node) {
  if (node.is_number() && !is_finite(*node.number())) {
    node.fail(fmt::format("a number of at most {:g}", kLargestNumber));
  }
  for (const JsonNode& element : node.is_array() ? node.elements() : std::vector<JsonNode>{}) check_numbers(element);
  for (const auto& [key, member] : node.members()) {
    check_numbers(member);
    constexpr std::string_view kInterval = "ci95";
    if (key == "se" || key.starts_with("se_")) (void)member.not_negative();
    if (key.starts_with(kInterval)) check_interval(node, member, key.substr(kInterval.size()));
  }
}

void check_parameter(const std::string& key, const JsonNode& parameter) {
  if (!parameter.has("status")) return;
  check_name<ParameterStatus>(parameter.member("status"));
  const std::optional<ParameterId> id = parameter_with_key(key);
  const std::optional<JsonNode> node = parameter.known("value");
  if (!id || !node) return;
  const Range& range = info(*id).range;
  const std::optional<double> value = node->number();
  if (value && !(range.low <= *value && *value <= range.high)) {
    node->fail(std::isfinite(range.high) ? fmt::format("a number from {} to {}", range.low, range.high)
                                         : fmt::format("a number >= {}", range.low));
  }
}

}  // namespace

void check_document(const JsonNode& document) {
  if (const JsonNode schema = document.member("schema"); schema.text() != "slipfit.fit/1") schema.fail("slipfit.fit/1");
  if (const auto status = document.known("status")) check_name<MotionClass>(*status);
  if (const auto parameters = document.known("parameters")) {
    if (!parameters->is_object()) parameters->fail("an object");
    for (const auto& [key, parameter] : parameters->members()) check_parameter(key, parameter);
  }
  check_numbers(document);
}

}  // namespace slipfit::documents
