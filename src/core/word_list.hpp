#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace slipfit {

/// Returns true if a list of words, separated by `separator`, contains the word.
inline bool is_in(std::string_view list, std::string_view word, char separator = ' ') {
  for (;;) {
    const std::size_t end = std::min(list.find(separator), list.size());
    if (list.substr(0, end) == word) return !word.empty();
    if (end == list.size()) return false;
    list.remove_prefix(end + 1);
  }
}

/// Returns true for characters that separate words on a line and for its end.
inline bool is_blank(char c) {
  return std::string_view(" \t\r\n\v\f").find(c) != std::string_view::npos;
}

/// Returns the text without surrounding blanks.
inline std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// ASCII letters only.
inline std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

}  // namespace slipfit
