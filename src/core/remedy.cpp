#include "slipfit/core/remedy.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <string_view>

#include "core/remedies.hpp"

namespace slipfit {
namespace {

// With which messages ask for something.
constexpr auto kRequests = std::to_array<std::string_view>(
    {"add",     "check", "choose", "compare", "copy",    "correct", "cut",  "export", "fill", "fit",  "give",
     "install", "leave", "look",   "make",    "measure", "mend",    "name", "open",   "put",  "read", "run",
     "save",    "set",   "sort",   "split",   "start",   "state",   "take", "unpack", "use",  "wait", "write"});

bool is_request(std::string_view text) {
  const auto end = std::ranges::find_if(text, [](char c) { return c == ' ' || c == '='; });
  if (end == text.end()) return false;
  std::string word(text.begin(), end);
  if (!word.empty()) word[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(word[0])));
  return std::ranges::find(kRequests, word) != kRequests.end();
}

/// Returns the first request after a punctuation mark, or an empty text.
std::string_view request_in(std::string_view message) {
  for (std::size_t i = 2; i < message.size(); ++i) {
    const bool is_after_mark =
        message[i - 1] == ' ' && std::string_view(";:,?").find(message[i - 2]) != std::string_view::npos;
    if (is_after_mark && is_request(message.substr(i))) return message.substr(i);
  }
  return {};
}

std::string_view expectation_in(std::string_view message) {
  const std::size_t place = message.rfind(" expected ");
  return place == std::string_view::npos ? std::string_view() : message.substr(place + 1);
}

std::string_view tabled_remedy(std::string_view code) {
  const auto* const row = std::ranges::find_if(kRemedies, [&](const auto& r) { return r.code == code; });
  return row == kRemedies.end() ? std::string_view() : row->remedy;
}

}  // namespace

std::string remedy_of(const Error& error) {
  const std::string_view message = error.message;
  const std::size_t semicolon = message.rfind("; ");
  const std::string_view last = semicolon == std::string_view::npos ? message : message.substr(semicolon);
  for (const std::string_view said : {request_in(last), request_in(message), expectation_in(message)}) {
    if (!said.empty()) return std::string(said);
  }
  return std::string(tabled_remedy(error.code));
}

}  // namespace slipfit
