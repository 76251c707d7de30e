#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/thrown_error.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/report/quantities.hpp"

namespace slipfit::documents {

/// The one JSON document that the text is, within bounds of size, depth and number of values. Throws ThrownError with
/// the code bad_document, which the functions of slipfit/report/fit_document.hpp return as their error.
nlohmann::json parse_document(const std::string& content, const std::string& name);

/// A value in a document that others wrote. What is missing or of another kind throws ThrownError that names
/// file, place and value: "'fit.json': parameters.damping_ratio.value is "0.1", expected ...".
class JsonNode {
 public:
  /// The document itself; both outlive the nodes.
  JsonNode(const std::string& file, const nlohmann::json& content) : file_(file), content_(content) {}

  struct Member;

  [[nodiscard]] bool is_null() const { return content_.is_null(); }
  [[nodiscard]] bool is_number() const { return content_.is_number(); }
  [[nodiscard]] bool is_object() const { return content_.is_object(); }
  [[nodiscard]] bool is_array() const { return content_.is_array(); }
  [[nodiscard]] bool has(const std::string& key) const { return content_.contains(key); }
  [[nodiscard]] JsonNode member(const std::string& key) const;
  /// A member of that member, and so on.
  template <class... Keys>
  [[nodiscard]] JsonNode member(const std::string& key, Keys... further) const {
    return member(key).member(further...);
  }
  /// The member (of that member, and so on), where there is one and it is not null.
  template <class... Keys>
  [[nodiscard]] std::optional<JsonNode> known(const std::string& key, Keys... further) const {
    if (!has(key) || member(key).is_null()) return std::nullopt;
    if constexpr (sizeof...(further) > 0) return member(key).known(further...);
    return member(key);
  }
  /// Returns the members, or nothing if the node is not an object.
  [[nodiscard]] std::vector<Member> members() const;
  /// Returns the elements of a list; `length`: that the list must have.
  [[nodiscard]] std::vector<JsonNode> elements(std::optional<std::size_t> length = {},
                                               const std::string& expected = "a list") const;
  /// Returns the elements of a list that may be absent.
  template <class... Keys>
  [[nodiscard]] std::vector<JsonNode> elements_of(Keys... keys) const {
    const std::optional<JsonNode> list = known(keys...);
    return list ? list->elements() : std::vector<JsonNode>{};
  }
  [[nodiscard]] std::string text() const;
  /// The value as JSON on one line.
  [[nodiscard]] std::string json_text() const { return content_.dump(); }
  /// Returns the number, or nothing if the node is null.
  [[nodiscard]] std::optional<double> number(const std::string& expected = "a number or null") const;
  /// Returns the number, which must be there and obey the rule that `expected` states.
  template <class Rule>
  [[nodiscard]] double number_that(const Rule& is_right, const std::string& expected) const {
    const std::optional<double> value = number(expected);
    if (!value || !is_right(*value)) fail(expected);
    return *value;
  }
  [[nodiscard]] double positive() const {
    return number_that([](double value) { return value > 0.0; }, "a number > 0");
  }
  /// Returns the number, which is not negative, or nothing if the node is null.
  [[nodiscard]] std::optional<double> not_negative() const;
  /// Returns the flag, or nothing if the node is null.
  [[nodiscard]] std::optional<bool> flag() const;
  /// Returns the text or the number of a member that may be absent.
  [[nodiscard]] std::string text_at(const std::string& key) const;
  [[nodiscard]] std::optional<double> number_at(const std::string& key) const;
  /// Returns { value, se, ci95, note }, the keys with this suffix.
  [[nodiscard]] Estimate estimate(const std::string& suffix = {}) const;
  [[noreturn]] void fail(const std::string& expected) const;

 private:
  JsonNode(const std::string& file, const nlohmann::json& content, std::string place)
      : file_(file), content_(content), place_(std::move(place)) {}
  [[nodiscard]] std::string place_of(const std::string& key) const;

  const std::string& file_;
  const nlohmann::json& content_;
  std::string place_;
};

struct JsonNode::Member {
  std::string key;
  JsonNode node;
};

/// Checks the properties that every reader of a fit document relies on: its schema; known statuses; values of
/// parameters in their ranges; standard errors that are not negative; intervals with low <= value <= high; numbers of a
/// size that can be squared and multiplied. Throws ThrownError with the code bad_document.
void check_document(const JsonNode& document);

/// Returns `read(document)` of a checked document, or the error.
template <class Value, class Read>
Result<Value> with_document(const std::string& content, const std::string& name, const Read& read) {
  try {
    const nlohmann::json json = parse_document(content, name);
    const JsonNode document(name, json);
    check_document(document);
    return read(document);
  } catch (const ThrownError& refused) {
    return refused.error();
  }
}

/// A quantity as a document states it, in SI.
struct DocumentQuantity {
  Estimate estimate;   ///< of a bounded or unidentified parameter the interval alone
  std::string status;  ///< of a parameter: identified, conditional, ...; else empty
};

/// Returns a quantity from its section, or nothing if it is absent or null. Forces of a friction coefficient are in the
/// object "coefficient".
std::optional<DocumentQuantity> quantity_in(const JsonNode& document, const Quantity& quantity);

Warnings warnings_in(const JsonNode& document);

}  // namespace slipfit::documents
