#include "io/message.hpp"

#include <fmt/format.h>

#include <boost/locale/utf.hpp>
#include <charconv>
#include <iterator>

#include "slipfit/core/printable.hpp"

namespace slipfit::reading {

using Utf8Traits = boost::locale::utf::utf_traits<char>;

Utf8 check_utf8(std::string_view text) {
  const char* p = text.data();
  const char* const end = p + text.size();
  while (p != end) {
    const auto code_point = Utf8Traits::decode(p, end);
    if (code_point == boost::locale::utf::incomplete) return Utf8::Cut;
    if (code_point == boost::locale::utf::illegal) return Utf8::Invalid;
  }
  return Utf8::Valid;
}

void append_utf8(std::string& text, unsigned code_point) {
  const bool is_valid = boost::locale::utf::is_valid_codepoint(code_point);
  Utf8Traits::encode(is_valid ? code_point : '?', std::back_inserter(text));
}

std::string to_utf8(std::string_view text) {
  if (check_utf8(text) == Utf8::Valid) return std::string(text);
  std::string result;
  for (const char c : text) append_utf8(result, static_cast<unsigned char>(c));
  return result;
}

std::string printable_utf8(std::string_view text) {
  return slipfit::printable(to_utf8(text));
}

std::optional<std::size_t> place_in_list(std::string_view text, std::size_t count) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  return is_number && number >= 1 && number <= count ? std::optional(number - 1) : std::nullopt;
}

std::string name_of_file(const std::filesystem::path& file) {
  return file == "-" ? "standard input" : slipfit::printable(file.string());
}

std::string table_was_read(std::string_view table) {
  return "Table '" + printable_utf8(table) + "' of the file was read; --variable chooses another.";
}

ThrownError duplicate_id(const std::string& file, const ManifestEntry& entry, std::size_t first_line) {
  return ThrownError(
      {"duplicate_id", fmt::format("{}:{}: column 'id': '{}' is also in line {}, expected a different id", file,
                                   entry.line, entry.id, first_line)});
}

ThrownError empty_manifest(const std::string& file) {
  return ThrownError({"empty_manifest", file + ": contains no recordings; expected a line for each"});
}

}  // namespace slipfit::reading
