#include "io/cells.hpp"

#include <catch2/catch.hpp>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

using namespace slipfit::reading;

TEST_CASE("plain numbers are the ones of std::from_chars, bit for bit") {
  constexpr unsigned kSeed = 20240611;
  CAPTURE(kSeed);
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 200'000; ++i) {
    const int decimals = static_cast<int>(random() % 18);
    const double size = std::pow(10.0, static_cast<double>(random() % 12));
    char text[64];
    std::snprintf(text, sizeof text, i % 5 == 0 ? "%.*e" : "%.*f", decimals,
                  (static_cast<double>(random()) / 1.8e19 - 0.5) * size);
    double expected = 0.0;
    const std::string point(text);
    std::from_chars(point.data(), point.data() + point.size(), expected);
    std::string comma = point;
    for (char& c : comma) c = c == '.' ? ',' : c;
    CAPTURE(point);
    if (plain_number(point, false) != expected) FAIL("with a point");
    const Decimal decimal = read_decimal(point.c_str(), nullptr, '.');
    if (!decimal.is_number || decimal.value != expected || *decimal.end != '\0') FAIL("up to a NUL");
    if (plain_number(comma, true) != expected) FAIL("with a comma");
  }
}

TEST_CASE("a plain number ends after its exponent, and too large numbers are left to the general reader") {
  for (const std::string text : {"1.5e-3,2", "-0.019128045292843208,2", "12345678901234567890;", "1e5 N"}) {
    const Decimal decimal = read_decimal(text.c_str(), nullptr, '.');
    CAPTURE(text);
    REQUIRE(decimal.is_number);
    CHECK(decimal.value == std::stod(text));
    CHECK(decimal.end == text.c_str() + text.find_first_of(",; "));
  }
  for (const std::string text : {"9.9e37", "1e999", "-", ".", "e5", "+1", "nan"}) {
    CAPTURE(text);
    CHECK_FALSE(read_decimal(text.c_str(), nullptr, '.').is_number);
  }
}

namespace {

struct CellText {
  std::string text;
  CellKind kind;
  double value;
  std::string tag;
};

const CellText kCases[] = {
    {" 1.5 ", CellKind::Number, 1.5, ""},
    {"+1.5", CellKind::Number, 1.5, ""},
    {"-.5e2", CellKind::Number, -50.0, ""},
    {"1.79 N1 ", CellKind::Number, 1.79, "N1"},
    {"10.5N", CellKind::Number, 10.5, "N"},
    {"\"2.5\"", CellKind::Number, 2.5, ""},
    {"01:02:03.5", CellKind::Clock, 3723.5, ""},
    {"", CellKind::Blank, 0.0, ""},
    {"\"\"", CellKind::Blank, 0.0, ""},
    {"NaN", CellKind::Missing, 0.0, ""},
    {"-inf", CellKind::Missing, 0.0, ""},
    {"nan N1", CellKind::Missing, 0.0, "N1"},
    {"#DIV/0!", CellKind::Missing, 0.0, ""},
    {"---", CellKind::Missing, 0.0, ""},
    {"Info", CellKind::Text, 0.0, ""},
    {"nano", CellKind::Text, 0.0, ""},
    {"1 2", CellKind::Text, 0.0, ""},
    {"2024-05-01", CellKind::Date, 0.0, ""},
    {"1.2.3", CellKind::Text, 0.0, ""},
    {"+-1", CellKind::Text, 0.0, ""},
    {"1e999", CellKind::Text, 0.0, ""},
    {"12:30", CellKind::Text, 0.0, ""},
    {"0,5", CellKind::Text, 0.0, ""},
};

}  // namespace

TEST_CASE("a cell is a number, a clock, missing, blank or text") {
  for (const CellText& c : kCases) {
    CAPTURE(c.text);
    const Cell cell = read_cell(c.text, false);
    CHECK(cell.kind == c.kind);
    CHECK(cell.tag == c.tag);
    if (c.kind == CellKind::Number || c.kind == CellKind::Clock) CHECK(cell.value == c.value);
  }
  CHECK(read_cell("0,5 N", true).value == 0.5);
  CHECK(read_cell("1.5", true).kind == CellKind::Text);
  CHECK(read_cell("5,", true).value == 5.0);
  CHECK(read_cell("5,on", true).kind == CellKind::Text);
}
