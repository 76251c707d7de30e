#include "report/document/document_values.hpp"

namespace slipfit::documents {

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
  for (const JsonNode& warning : document.elements("warnings"))
    warnings.push_back({warning.member("code").text(), warning.member("message").text()});
  return warnings;
}

}  // namespace slipfit::documents
