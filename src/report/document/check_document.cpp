#include "report/document/check_document.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/names.hpp"
#include "slipfit/core/range.hpp"
#include "slipfit/fit/parameter.hpp"

namespace slipfit::documents {
namespace {

/// Refuses a text that is not the name of one of the choices.
template <class Choices>
void check_name(const JsonNode& node, const Choices& choices) {
  if (with_name(choices, node.text())) return;
  std::string known;
  for (const auto choice : choices) known += (known.empty() ? "" : ", ") + std::string(name_of(choice));
  node.fail("one of " + known);
}

/// The interval, and the value next to it whose key has the same ending (value_Hz and ci95_Hz).
void check_interval(const JsonNode& estimate, const JsonNode& interval, const std::string& ending) {
  if (interval.is_null()) return;
  const std::string expected = "[low, high] with low <= high, or null";
  if (interval.array_size() != 2) interval.fail(expected);
  const std::optional<double> low = interval.element(0).number();
  const std::optional<double> high = interval.element(1).number();
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
  for (std::size_t i = 0; node.is_array() && i < node.array_size(); ++i) check_numbers(node.element(i));
  for (const auto& [key, member] : node.members()) {
    check_numbers(member);
    constexpr std::string_view kInterval = "ci95";
    if (key == "se" || key.starts_with("se_")) (void)checked_error(member);
    if (key.starts_with(kInterval)) check_interval(node, member, key.substr(kInterval.size()));
  }
}

void check_parameter(const std::string& key, const JsonNode& parameter) {
  if (!parameter.has("status")) return;
  check_name(parameter.member("status"), kParameterStatuses);
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

std::optional<double> checked_error(const JsonNode& node) {
  const std::optional<double> error = node.number();
  if (error && !(*error >= 0.0)) node.fail("a number >= 0 or null");
  return error;
}

void check_document(const JsonNode& document) {
  if (const JsonNode schema = document.member("schema"); schema.text() != "slipfit.fit/1") schema.fail("slipfit.fit/1");
  if (const auto status = document.known("status")) check_name(*status, kMotions);
  if (const auto parameters = document.known("parameters")) {
    if (!parameters->is_object()) parameters->fail("an object");
    for (const auto& [key, parameter] : parameters->members()) check_parameter(key, parameter);
  }
  check_numbers(document);
}

}  // namespace slipfit::documents
