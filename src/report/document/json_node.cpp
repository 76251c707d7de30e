#include "report/document/json_node.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>

#include "report/names.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/core/range.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/report/fit_document.hpp"

using nlohmann::json;

namespace slipfit::documents {

namespace {

// A document has some hundred values a recording, eight levels deep; beyond these bounds it is damaged, or made to take
// all memory.
constexpr int kDeepest = 64;
constexpr std::size_t kMostValues = std::size_t{1} << 21U;

[[noreturn]] void refuse_document(const std::string& name, const std::string& message) {
  throw ThrownError(Error{"bad_document", fmt::format("'{}': {}", printable(name), message)});
}

}  // namespace

json parse_document(const std::string& content, const std::string& name) {
  if (content.size() > kLargestFitDocument) {
    refuse_document(name, fmt::format("is too large for a fit document ({} MiB at most)", kLargestFitDocument >> 20U));
  }
  std::size_t values = 0;
  const auto check_bounds = [&](int depth, json::parse_event_t event, const json& /*parsed*/) {
    const bool is_end = event == json::parse_event_t::object_end || event == json::parse_event_t::array_end;
    if (depth > kDeepest) refuse_document(name, "is nested too deeply for a fit document");
    if (!is_end && ++values > kMostValues) refuse_document(name, "contains too many values for a fit document");
    return true;
  };
  try {
    return json::parse(content, check_bounds);
  } catch (const json::parse_error& error) {
    const std::size_t read = std::min(error.byte, content.size());
    const auto lines = std::count(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(read), '\n');
    refuse_document(fmt::format("{}:{}", name, lines + 1),
                    "is not one JSON document, expected what slipfit fit --json --out FIT.json writes");
  } catch (const json::exception&) {
    refuse_document(name, "has a number that is too large, expected what slipfit fit --json --out FIT.json writes");
  }
}

JsonNode JsonNode::member(const std::string& key) const {
  if (!content_.is_object()) fail("an object");
  const auto found = content_.find(key);
  if (found == content_.end()) {
    refuse_document(file_,
                    fmt::format("{} is missing: write the document again with slipfit fit --json", place_of(key)));
  }
  return {file_, *found, place_of(key)};
}

std::vector<JsonNode> JsonNode::elements(std::optional<std::size_t> length, const std::string& expected) const {
  if (!content_.is_array() || (length && content_.size() != *length)) fail(expected);
  std::vector<JsonNode> all;
  for (const json& element : content_) all.push_back({file_, element, fmt::format("{}[{}]", place_, all.size())});
  return all;
}

std::string JsonNode::text() const {
  if (!content_.is_string()) fail("a text");
  return content_.get<std::string>();
}

std::optional<double> JsonNode::number(const std::string& expected) const {
  if (content_.is_null()) return std::nullopt;
  if (!content_.is_number()) fail(expected);
  return content_.get<double>();
}

std::optional<double> JsonNode::not_negative() const {
  const std::optional<double> value = number();
  if (value && !(*value >= 0.0)) fail("a number >= 0 or null");
  return value;
}

std::vector<JsonNode::Member> JsonNode::members() const {
  std::vector<Member> all;
  if (!content_.is_object()) return all;
  for (const auto& [key, value] : content_.items()) all.push_back({key, {file_, value, place_of(key)}});
  return all;
}

std::optional<bool> JsonNode::flag() const {
  if (content_.is_null()) return std::nullopt;
  if (!content_.is_boolean()) fail("true or false");
  return content_.get<bool>();
}

std::string JsonNode::text_at(const std::string& key) const {
  const std::optional<JsonNode> found = known(key);
  return found ? found->text() : std::string();
}

std::optional<double> JsonNode::number_at(const std::string& key) const {
  const std::optional<JsonNode> found = known(key);
  return found ? found->number() : std::nullopt;
}

Estimate JsonNode::estimate(const std::string& suffix) const {
  Estimate estimate{number_at("value" + suffix), number_at("se" + suffix), {}, text_at("note")};
  if (const auto bounds = known("ci95" + suffix)) {
    const std::vector<JsonNode> ends = bounds->elements();  // two numbers, as check_document demands
    estimate.ci95 = Interval{*ends[0].number(), *ends[1].number()};
  }
  return estimate;
}

void JsonNode::fail(const std::string& expected) const {
  std::string shown = content_.dump(-1, ' ', true, json::error_handler_t::replace);
  constexpr std::size_t kLongest = 40;
  if (shown.size() > kLongest) shown = shown.substr(0, kLongest) + "...";
  refuse_document(file_,
                  fmt::format("{} is {}, expected {}", place_.empty() ? "the document" : place_, shown, expected));
}

std::string JsonNode::place_of(const std::string& key) const {
  return place_.empty() ? key : place_ + "." + key;
}

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

std::optional<DocumentQuantity> quantity_in(const JsonNode& document, const Quantity& quantity) {
  const std::optional<JsonNode> section = document.known(std::string(quantity.section));
  if (!section || !section->is_object()) return std::nullopt;
  if (quantity.section == "frequency") return DocumentQuantity{section->estimate("_Hz"), {}};
  const std::string key(quantity.key);
  const std::optional<JsonNode> node = section->known(key);
  if (node && node->is_number()) return DocumentQuantity{{node->number(), {}, {}, {}}, {}};
  if (!node) {
    const std::optional<JsonNode> coefficient = section->known("coefficient");
    if (!coefficient || !key.ends_with("_N")) return std::nullopt;
    return DocumentQuantity{{coefficient->number_at(key.substr(0, key.size() - 2)), {}, {}, {}}, {}};
  }
  if (!node->is_object()) return std::nullopt;
  DocumentQuantity found{node->estimate(), node->text_at("status")};
  if (found.status == "bounded" || found.status == "unidentified") found.estimate.value.reset();
  return found;
}

Warnings warnings_in(const JsonNode& document) {
  Warnings warnings;
  for (const JsonNode& warning : document.elements_of("warnings"))
    warnings.push_back({warning.member("code").text(), warning.member("message").text()});
  return warnings;
}

}  // namespace slipfit::documents
