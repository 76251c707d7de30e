#include "slipfit/core/units.hpp"

#include <udunits2.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "core/unit_spellings.hpp"

namespace slipfit {
namespace {

struct DimensionName {
  std::string_view quantity;
  std::string_view si_unit;
  std::string_view examples;
};

DimensionName name_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::Time:
      return {"time", "s", "s, ms, min"};
    case Dimension::Length:
      return {"length", "m", "m, mm, um"};
    case Dimension::Speed:
      return {"speed", "m/s", "m/s, mm/s, mm/min"};
    case Dimension::Force:
      return {"force", "N", "N, mN, gf"};
    case Dimension::Frequency:
      return {"frequency", "Hz", "Hz, kHz, 1/s"};
    case Dimension::Mass:
      return {"mass", "kg", "kg, g, mg"};
    case Dimension::AngularSpeed:
      return {"angular speed", "rad/s", "rad/s, rpm"};
    case Dimension::Dimensionless:
      return {"pure number", "1", "1, %"};
  }
  return {"quantity", "1", "1"};
}

std::string_view trim(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string join(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) text += part;
  return text;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

struct Replacement {
  std::string_view from;
  std::string_view to;
};

// Both micro signs (U+00B5, U+03BC), the dots, minus and superscripts of a typeset unit, in UTF-8.
constexpr std::array kReplacements = std::to_array<Replacement>({
    {"\xC2\xB5", "u"},
    {"\xCE\xBC", "u"},
    {"\xC2\xB7", "."},
    {"\xE2\x8B\x85", "."},
    {"\xE2\x88\x92", "-"},
    {"\xE2\x81\xBB", "-"},
    {"\xC2\xB9", "1"},
    {"\xC2\xB2", "2"},
    {"\xE2\x88\x95", "/"},
});

/// Typeset and Latin-1 spellings become the ASCII that UDUNITS-2 knows; a final dot ("mm/min.") goes.
std::string normalise(std::string_view unit) {
  std::string text;
  for (std::size_t i = 0; i < unit.size();) {
    const auto rest = unit.substr(i);
    const auto* const found = std::find_if(kReplacements.begin(), kReplacements.end(),
                                           [&](const Replacement& r) { return rest.starts_with(r.from); });
    if (found != kReplacements.end()) {
      text += found->to;
      i += found->from.size();
    } else if (static_cast<unsigned char>(rest[0]) >= 0xC2 && rest.size() > 1 && (rest[1] & 0xC0) == 0x80) {
      text += rest.substr(0, 2);  // another UTF-8 letter
      i += 2;
    } else {
      text += rest[0] == '\xB5' ? 'u' : rest[0] == '\xB7' ? '.' : rest[0];  // Latin-1
      ++i;
    }
  }
  while (text.size() > 1 && text.back() == '.') text.pop_back();
  return text;
}

template <class Table>
std::optional<double> look_up(const Table& table, std::string_view text, Dimension dimension) {
  for (const Spelling& entry : table) {
    if (entry.dimension == dimension && entry.text == text) return entry.scale;
  }
  return std::nullopt;
}

struct FreeSystem {
  void operator()(ut_system* system) const { ut_free_system(system); }
};
struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
struct FreeConverter {
  void operator()(cv_converter* converter) const { cv_free(converter); }
};
using Unit = std::unique_ptr<ut_unit, FreeUnit>;

/// UDUNITS-2 prints what it does not like; it has one handler a process, which is put back afterwards.
class Silence {
 public:
  Silence() : previous_(ut_set_error_message_handler(ut_ignore)) {}
  ~Silence() { ut_set_error_message_handler(previous_); }
  Silence(const Silence&) = delete;
  Silence(Silence&&) = delete;
  Silence& operator=(const Silence&) = delete;
  Silence& operator=(Silence&&) = delete;

 private:
  ut_error_message_handler previous_;
};

/// The factor between two units of the same dimension; nothing for offsets, logarithms and reciprocals
/// (UDUNITS-2 converts seconds to hertz when asked).
std::optional<double> linear_factor(ut_unit* from, ut_unit* to) {
  if (ut_are_convertible(from, to) == 0) return std::nullopt;
  const std::unique_ptr<cv_converter, FreeConverter> converter(ut_get_converter(from, to));
  if (!converter) return std::nullopt;
  const double one = cv_convert_double(converter.get(), 1.0);
  const double two = cv_convert_double(converter.get(), 2.0);
  const bool linear = cv_convert_double(converter.get(), 0.0) == 0.0 && std::abs(two - 2.0 * one) <= 1e-12 * one;
  return linear && one > 0.0 && std::isfinite(one) ? std::optional(one) : std::nullopt;
}

bool contains_radian(ut_unit* unit) {
  std::array<char, 256> text{};
  const int length = ut_format(unit, text.data(), text.size() - 1, UT_ASCII | UT_DEFINITION);
  return length > 0 && std::string_view(text.data()).find("rad") != std::string_view::npos;
}

/// By UDUNITS-2, whose parser has global state: one caller at a time.
std::optional<double> ask_udunits(const std::string& text, Dimension dimension) {
  if (dimension == Dimension::Dimensionless || text.empty() || text.find('@') != std::string::npos) return std::nullopt;
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  const Silence silence;
  static const std::unique_ptr<ut_system, FreeSystem> system(ut_read_xml(nullptr));
  if (!system) return std::nullopt;
  const Unit unit(ut_parse(system.get(), text.c_str(), UT_UTF8));
  if (!unit || contains_radian(unit.get()) != (dimension == Dimension::AngularSpeed)) return std::nullopt;
  const Unit si(ut_parse(system.get(), std::string(name_of(dimension).si_unit).c_str(), UT_ASCII));
  if (const auto factor = linear_factor(unit.get(), si.get())) return factor;
  if (dimension != Dimension::Force) return std::nullopt;
  // Scales and load cells show masses where a force is meant: "g", "mg", "lb".
  const Unit kilogram(ut_parse(system.get(), "kg", UT_ASCII));
  const auto mass_kg = linear_factor(unit.get(), kilogram.get());
  return mass_kg ? std::optional(*mass_kg * kStandardGravity_m_per_s2) : std::nullopt;
}

/// On one line, whatever was given: a message is.
std::string shown(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || c == '\x7F') c = '?';
  }
  return result;
}

}  // namespace

Result<UnitScale> parse_unit(std::string_view unit, Dimension dimension) {
  const std::string text = normalise(trim(unit));
  auto scale = look_up(kSpellings, text, dimension);
  if (!scale) scale = look_up(kWords, lower(text), dimension);
  if (!scale) scale = ask_udunits(text, dimension);
  if (!scale) scale = look_up(kSpellings, lower(text), dimension);  // "MM/S"
  if (scale) return UnitScale{*scale};
  const DimensionName name = name_of(dimension);
  return Error{"unknown_unit", join({"'", shown(unit), "' is not a unit of ", name.quantity, "; expected one such as ",
                                     name.examples})};
}

Result<double> parse_quantity(std::string_view text, Dimension dimension) {
  std::string_view rest = trim(text);
  const Error bad_number{"bad_number",
                         join({"'", shown(text), "' is not a finite number, or one with a unit (such as 10 ",
                               name_of(dimension).si_unit, ")"})};
  if (rest.size() > 1 && rest[0] == '+' && rest[1] != '-') rest.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return bad_number;
  rest = trim(rest.substr(static_cast<std::size_t>(end - rest.data())));
  if (rest.empty()) return value;
  if (rest.front() == ',' || rest.front() == ';') return bad_number;  // "0,5": a decimal comma is not guessed at here
  const auto unit = rest.front() == '/' ? parse_unit(join({"1", rest}), dimension) : parse_unit(rest, dimension);
  if (!unit) return unit.error();
  const double value_SI = value * unit.value().scale;
  if (!std::isfinite(value_SI)) return bad_number;
  return value_SI;
}

}  // namespace slipfit
