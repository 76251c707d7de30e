#pragma once

#ifdef SLIPFIT_HAS_XLSX
#include <optional>
#include <pugixml.hpp>
#include <string>

namespace slipfit::reading {

/// The document in `text`, parsed with the options of pugixml; empty if it is not XML. Its nodes take at most 1 GB of
/// memory: a text of short elements needs some 30 times its size. Error: container_too_large, before anything is built.
std::optional<pugi::xml_document> parse_xml(const std::string& text, unsigned options, const std::string& file);

}  // namespace slipfit::reading
#endif
