#include "slipfit/core/printable.hpp"

#include <algorithm>
#include <array>
#include <boost/locale/utf.hpp>

namespace slipfit {
namespace {

using CodePoint = boost::locale::utf::code_point;
using Utf8 = boost::locale::utf::utf_traits<char>;

struct Span {
  CodePoint first = 0;
  CodePoint last = 0;
};

/// Cc, Cf, Zl and Zp of Unicode 15, and the block of tags as a whole.
constexpr std::array kEscaped = std::to_array<Span>(
    {{0x0, 0x1F},        {0x7F, 0x9F},       {0xAD, 0xAD},       {0x600, 0x605},     {0x61C, 0x61C},
     {0x6DD, 0x6DD},     {0x70F, 0x70F},     {0x890, 0x891},     {0x8E2, 0x8E2},     {0x180E, 0x180E},
     {0x200B, 0x200F},   {0x2028, 0x202E},   {0x2060, 0x2064},   {0x2066, 0x206F},   {0xFEFF, 0xFEFF},
     {0xFFF9, 0xFFFB},   {0x110BD, 0x110BD}, {0x110CD, 0x110CD}, {0x13430, 0x1343F}, {0x1BCA0, 0x1BCA3},
     {0x1D173, 0x1D17A}, {0xE0000, 0xE0FFF}});

bool is_escaped(CodePoint code_point) {
  const auto* const span = std::ranges::lower_bound(kEscaped, code_point, {}, &Span::last);
  return span != kEscaped.end() && code_point >= span->first;
}

bool is_plain_ascii(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0x20 && byte < 0x7F;
}

void append_digits(std::string& text, CodePoint number, unsigned digits) {
  for (unsigned left = digits; left > 0; --left) text += "0123456789abcdef"[(number >> (4 * (left - 1))) & 0xFU];
}

void append_escape(std::string& text, CodePoint code_point) {
  constexpr CodePoint kFirstOfPairs = 0x10000;
  if (code_point >= kFirstOfPairs) {
    append_escape(text, 0xD800 + ((code_point - kFirstOfPairs) >> 10U));
    append_escape(text, 0xDC00 + ((code_point - kFirstOfPairs) & 0x3FFU));
    return;
  }
  if (code_point == '\n' || code_point == '\t' || code_point == '\r') {
    text += '\\';
    text += code_point == '\n' ? 'n' : code_point == '\t' ? 't' : 'r';
    return;
  }
  text += "\\u";
  append_digits(text, code_point, 4);
}

std::string escaped(std::string_view text, std::string_view kept) {
  std::string result;
  result.reserve(text.size());
  const char* const end = text.data() + text.size();
  for (const char* at = text.data(); at != end;) {
    const char* const plain = std::find_if_not(at, end, is_plain_ascii);
    result.append(at, plain);
    at = plain;
    if (at == end) break;
    const char* next = at;
    const CodePoint code_point = Utf8::decode(next, end);
    if (code_point == boost::locale::utf::illegal || code_point == boost::locale::utf::incomplete) {
      result += "\\x";
      append_digits(result, static_cast<unsigned char>(*at++), 2);
      continue;
    }
    const bool is_kept = kept.find(*at) != std::string_view::npos || !is_escaped(code_point);
    is_kept ? void(result.append(at, next)) : append_escape(result, code_point);
    at = next;
  }
  return result;
}

}  // namespace

std::string printable(std::string_view text) {
  return escaped(text, {});
}

std::string printable_lines(std::string_view text) {
  return escaped(text, "\n\t");
}

}  // namespace slipfit
