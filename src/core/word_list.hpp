#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace slipfit {

/// Whether a list of words, parted by `separator`, holds the word.
inline bool is_in(std::string_view list, std::string_view word, char separator = ' ') {
  for (;;) {
    const std::size_t end = std::min(list.find(separator), list.size());
    if (list.substr(0, end) == word) return !word.empty();
    if (end == list.size()) return false;
    list.remove_prefix(end + 1);
  }
}

/// ASCII letters only.
inline std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

}  // namespace slipfit
