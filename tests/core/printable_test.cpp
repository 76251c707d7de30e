#include "slipfit/core/printable.hpp"

#include <catch2/catch.hpp>

using slipfit::printable;
using slipfit::printable_lines;

TEST_CASE("printable: text without control or format characters stays as it is") {
  for (const char* const text : {"", "run 7.csv", "Prüfung µ=0.3 ±", "Versuch '日本' \\n", "\U0001F600 e\u0301"}) {
    CHECK(printable(text) == text);
    CHECK(printable_lines(text) == text);
  }
}

TEST_CASE("printable: what moves a terminal's cursor or reorders a line is escaped") {
  CHECK(printable("a\nb\tc\rd") == "a\\nb\\tc\\rd");
  CHECK(printable("\x1b[31m\x07\x7f") == "\\u001b[31m\\u0007\\u007f");
  CHECK(printable(std::string_view("\0", 1)) == "\\u0000");
  CHECK(printable("\u0085\u009b2J\u00ad") == "\\u0085\\u009b2J\\u00ad");
  CHECK(printable("fdp.\u202evsc\u2069\u200b\ufeff") == "fdp.\\u202evsc\\u2069\\u200b\\ufeff");
  CHECK(printable("\u2028\u2029\u061c\u180e\u2060\u206f\ufff9") == "\\u2028\\u2029\\u061c\\u180e\\u2060\\u206f\\ufff9");
  CHECK(printable("\U000E0001\U000E007F\U0001D173") == "\\udb40\\udc01\\udb40\\udc7f\\ud834\\udd73");
  CHECK(printable_lines("a\n\tb\r\u202e\n") == "a\n\tb\\r\\u202e\n");
}

TEST_CASE("printable: the neighbours of escaped characters remain") {
  for (const char* const text : {" ~", "\u00a0\u00ac\u00ae", "\u0606\u061b\u061d",
                                 "\u200a\u2010\u2027\u202f\u205f\u2065\u2070", "\ufff8\ufffc"}) {
    CHECK(printable(text) == text);
  }
}

TEST_CASE("printable: bytes that are not UTF-8 are escaped one by one") {
  CHECK(printable("Pr\xfc"
                  "fung") == "Pr\\xfcfung");
  CHECK(printable("\xe2\x80") == "\\xe2\\x80");           // cut
  CHECK(printable("\xed\xa0\x80") == "\\xed\\xa0\\x80");  // half of a surrogate pair
  CHECK(printable("\xc0\x9b") == "\\xc0\\x9b");           // ESC-like, overlong
  CHECK(printable("\x9b"
                  "2J\xffok") == "\\x9b2J\\xffok");
}

TEST_CASE("printable: a printable text is printable") {
  const std::string once = printable("a\n\u202e\xff\x1b\U000E0001");
  CHECK(printable(once) == once);
}
