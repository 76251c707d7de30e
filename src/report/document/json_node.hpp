#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/thrown_error.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"
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
  /// The member, where there is one and it is not null.
  [[nodiscard]] std::optional<JsonNode> known(const std::string& key) const;
  /// Returns a member of that member if it is not null.
  [[nodiscard]] std::optional<JsonNode> known(const std::string& key, const std::string& further) const;
  /// Returns the members, or nothing if the node is not an object.
  [[nodiscard]] std::vector<Member> members() const;
  [[nodiscard]] JsonNode element(std::size_t index) const;  ///< index < array_size()
  [[nodiscard]] std::size_t array_size() const;
  /// Returns the elements of a list that may be absent: a member, or a member of that member.
  template <class... Keys>
  [[nodiscard]] std::vector<JsonNode> elements(const Keys&... keys) const {
    const std::optional<JsonNode> list = known(keys...);
    std::vector<JsonNode> all;
    for (std::size_t i = 0; list && i < list->array_size(); ++i) all.push_back(list->element(i));
    return all;
  }
  [[nodiscard]] std::string text() const;
  /// The value as JSON on one line.
  [[nodiscard]] std::string json_text() const { return content_.dump(); }
  /// Returns the number, or nothing if the node is null.
  [[nodiscard]] std::optional<double> number(const std::string& expected = "a number or null") const;
  [[nodiscard]] double positive() const;
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
