#include "io/container/xml.hpp"

#ifdef SLIPFIT_HAS_XLSX
#include <string_view>

#include "io/container/formats.hpp"

namespace slipfit::reading {
namespace {

constexpr std::size_t kMostNodeBytes = std::size_t{1} << 30U;

/// Upper bound of the memory that pugixml 1.13 takes for the nodes and attributes of a text.
std::size_t node_bytes(std::string_view text) {
  constexpr std::size_t kNode = 64;
  constexpr std::size_t kAttribute = 40;
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '=') bytes += kAttribute;
    if (text[i] == '<' && text.substr(i + 1, 1) != "/") bytes += kNode;
    if (text[i] != '>') continue;
    const std::size_t next = text.find_first_not_of(" \t\r\n", i + 1);  // white space between elements makes no node
    if (next == std::string_view::npos) break;
    if (text[next] != '<') bytes += kNode;
    i = next - 1;
  }
  return bytes;
}

}  // namespace

std::optional<pugi::xml_document> parse_xml(const std::string& text, unsigned options, const std::string& file) {
  if (node_bytes(text) > kMostNodeBytes) throw too_large(file);
  std::optional<pugi::xml_document> document(std::in_place);
  if (!document->load_buffer(text.data(), text.size(), options | pugi::parse_embed_pcdata)) document.reset();
  return document;
}

}  // namespace slipfit::reading
#endif
