#include "slipfit/core/units.hpp"

#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>

#include "core/number_text.hpp"
#include "core/unit_text.hpp"

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

/// The factor to the SI unit of a dimension. Scales and load cells show masses where a force is meant ("g", "lb"), and
/// turns are counted as frequencies ("rpm"). A quotient of equal units ("mV/V") is no friction coefficient.
std::optional<double> factor_in(const ParsedUnit& unit, std::string_view text, Dimension dimension) {
  const auto is = [&unit](const Powers& powers) { return unit.powers == powers; };
  const auto given_if = [&unit](bool fits) { return fits ? std::optional(unit.factor) : std::nullopt; };
  switch (dimension) {
    case Dimension::Time:
      return given_if(is(kSecond));
    case Dimension::Length:
      return given_if(is(kMetre));
    case Dimension::Speed:
      return given_if(is(kSpeed));
    case Dimension::Force:
      if (is(kKilogram)) return unit.factor * kStandardGravity_m_per_s2;
      return given_if(is(kNewton));
    case Dimension::Frequency:
      return given_if(is(kPerSecond) || is(kTurnsPerSecond));
    case Dimension::Mass:
      return given_if(is(kKilogram));
    case Dimension::AngularSpeed:
      if (is(kTurnsPerSecond)) return unit.factor * kTurn_rad;
      return given_if(is(kRadiansPerSecond));
    case Dimension::Dimensionless:
      return given_if(is(kPureNumber) && text.find('/') == std::string_view::npos);
  }
  return std::nullopt;
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
  const std::string_view text = trim(unit);
  const auto parsed = read_unit(text);
  const auto scale = parsed ? factor_in(*parsed, text, dimension) : std::nullopt;
  if (scale) return UnitScale{*scale};
  const DimensionName name = name_of(dimension);
  return Error{"unknown_unit", join({"'", shown(unit), "' is not a unit of ", name.quantity, "; expected one such as ",
                                     name.examples})};
}

std::string_view unit_in(std::string_view text) {
  text = trim(text);
  if (text.size() > 1 && text[0] == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = number_from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() ? trim(text.substr(static_cast<std::size_t>(end - text.data()))) : std::string_view();
}

Result<double> parse_quantity(std::string_view text, Dimension dimension) {
  std::string_view rest = trim(text);
  const Error bad_number{"bad_number",
                         join({"'", shown(text), "' is not a finite number, or one with a unit (such as 10 ",
                               name_of(dimension).si_unit, ")"})};
  if (rest.size() > 1 && rest[0] == '+' && rest[1] != '-') rest.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = number_from_chars(rest.data(), rest.data() + rest.size(), value);
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
