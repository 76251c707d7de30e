#include "slipfit/core/units.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>

#include "core/number_text.hpp"
#include "core/unit_text.hpp"
#include "core/word_list.hpp"

namespace slipfit {
namespace {

struct DimensionInfo {
  std::string_view quantity;
  std::string_view si_unit;
  std::string_view examples;
  Powers powers;
  Powers other{};             ///< a second kind of unit that is read for it
  double other_factor = 0.0;  ///< from that kind to the SI unit; 0: there is none
};

/// In the order of Dimension. Scales and load cells show masses where a force is meant ("g", "lb"), and turns are
/// counted as frequencies ("rpm").
constexpr std::array<DimensionInfo, 12> kDimensions{
    {{"time", "s", "s, ms, min", kSecond},
     {"length", "m", "m, mm, um", kMetre},
     {"speed", "m/s", "m/s, mm/s, mm/min", kSpeed},
     {"force", "N", "N, mN, gf", kNewton, kKilogram, kStandardGravity_m_per_s2},
     {"frequency", "Hz", "Hz, kHz, 1/s", kPerSecond, kTurnsPerSecond, 1.0},
     {"mass", "kg", "kg, g, mg", kKilogram},
     {"angular speed", "rad/s", "rad/s, rpm", kRadiansPerSecond, kTurnsPerSecond, kTurn_rad},
     {"pure number", "1", "1, %", kPureNumber},
     {"torque", "N m", "N m, mN m, in lbf", kJoule, kKilogramMetre, kStandardGravity_m_per_s2},
     {"stiffness", "N/m", "N/m, kN/m, N/mm", kNewtonPerMetre},
     {"time divided by length", "s/m", "s/m, s/mm", kSecondPerMetre},
     {"force divided by time", "N/s", "N/s, mN/s", kNewtonPerSecond}}};

const DimensionInfo& info_of(Dimension dimension) {
  return kDimensions.at(static_cast<std::size_t>(dimension));
}

std::string join(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) text += part;
  return text;
}

/// The factor to the SI unit of a dimension. A quotient of equal units ("mV/V") is no friction coefficient.
std::optional<double> factor_in(const ParsedUnit& unit, std::string_view text, Dimension dimension) {
  const DimensionInfo& info = info_of(dimension);
  if (dimension == Dimension::Dimensionless && text.find('/') != std::string_view::npos) return std::nullopt;
  if (unit.powers == info.powers) return unit.factor;
  const bool is_other = info.other_factor > 0.0 && unit.powers == info.other;
  return is_other ? std::optional(unit.factor * info.other_factor) : std::nullopt;
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

Result<double> parse_unit(std::string_view unit, Dimension dimension) {
  const std::string_view text = trim(unit);
  const auto parsed = read_unit(text);
  const auto scale = parsed ? factor_in(*parsed, text, dimension) : std::nullopt;
  if (scale) return *scale;
  const DimensionInfo& info = info_of(dimension);
  return Error{"unknown_unit", join({"'", shown(unit), "' is not a unit of ", info.quantity, "; expected one such as ",
                                     info.examples})};
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
                               info_of(dimension).si_unit, ")"})};
  if (rest.size() > 1 && rest[0] == '+' && rest[1] != '-') rest.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = number_from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return bad_number;
  rest = trim(rest.substr(static_cast<std::size_t>(end - rest.data())));
  if (rest.empty()) return value;
  if (rest.front() == ',')
    return Error{"bad_number", join({"'", shown(text), "' has a comma: write the decimal sign as a point"})};
  if (rest.front() == ';') return bad_number;
  const auto unit = rest.front() == '/' ? parse_unit(join({"1", rest}), dimension) : parse_unit(rest, dimension);
  if (!unit) return unit.error();
  const double value_SI = value * unit.value();
  if (!std::isfinite(value_SI)) return bad_number;
  return value_SI;
}

}  // namespace slipfit
