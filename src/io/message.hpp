#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/thrown_error.hpp"
#include "slipfit/io/manifest_entry.hpp"

namespace slipfit::reading {

/// Cut: the last character is not complete.
enum class Utf8 { Valid, Cut, Invalid };
Utf8 check_utf8(std::string_view text);

/// Appends a code point in UTF-8; a half of a surrogate pair as '?'.
void append_utf8(std::string& text, unsigned code_point);

/// UTF-8 as it is; anything else is taken for Latin-1 and converted.
std::string to_utf8(std::string_view text);

/// Text of a file, in UTF-8 or Latin-1, as one line that slipfit::printable makes of it.
std::string printable_utf8(std::string_view text);

/// 0-based, of a 1-based number as text; empty where the text is none, or one beyond `count`.
std::optional<std::size_t> place_in_list(std::string_view text, std::size_t count);

/// Returns the name of a file as messages and reports show it; "-" is standard input.
std::string name_of_file(const std::filesystem::path& file);

/// The texts of the first `most` of `count` items, parted by commas, then `more` if there are more.
template <class TextOf>
std::string listed(std::size_t count, std::size_t most, const TextOf& text_of, std::string_view more = ", ...") {
  std::string list;
  for (std::size_t i = 0; i < std::min(count, most); ++i) list.append(i == 0 ? "" : ", ").append(text_of(i));
  return count > most ? list.append(more) : list;
}

/// Says which of the tables in a file was read.
std::string table_was_read(std::string_view table);

/// Returns an error about a manifest; messages show `file`.
ThrownError duplicate_id(const std::string& file, const ManifestEntry& entry, std::size_t first_line);
ThrownError empty_manifest(const std::string& file);

}  // namespace slipfit::reading
