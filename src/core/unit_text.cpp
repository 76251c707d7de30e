#include "core/unit_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <span>
#include <string>

#include "core/word_list.hpp"

namespace slipfit {

namespace {

constexpr std::size_t kLongestUnit = 64;
constexpr char kUnitSeparator = '|';  // no unit holds it

struct Replacement {
  std::string_view from;
  std::string_view to;
};

// Both micro signs (U+00B5, U+03BC), ohm, dots, minus, degree and superscripts of a typeset unit, in UTF-8.
constexpr std::array kReplacements = std::to_array<Replacement>({
    {"\xC2\xB5", "u"},
    {"\xCE\xBC", "u"},
    {"\xCE\xA9", "Ohm"},
    {"\xE2\x84\xA6", "Ohm"},
    {"\xE2\x84\x83", "degC"},
    {"\xC2\xB7", "."},
    {"\xE2\x8B\x85", "."},
    {"\xE2\x88\x92", "-"},
    {"\xE2\x81\xBB", "-"},
    {"\xC2\xB9", "1"},
    {"\xC2\xB2", "2"},
    {"\xC2\xB3", "3"},
    {"\xE2\x88\x95", "/"},
    {"\xE2\x80\xB0", "\xE2\x80\xB0"},
    {" per ", "/"},
    {"_per_", "/"},
    {"N_m", "N m"},
});

// The same of single bytes in Latin-1.
constexpr std::array kLatin1 =
    std::to_array<Replacement>({{"\xB5", "u"}, {"\xB7", "."}, {"\xB0", "\xC2\xB0"}, {"\xB2", "2"}, {"\xB3", "3"}});

const Replacement* replacement_in(std::span<const Replacement> table, std::string_view rest) {
  const auto found = std::ranges::find_if(table, [&](const Replacement& r) { return rest.starts_with(r.from); });
  return found == table.end() ? nullptr : &*found;
}

/// Typeset and Latin-1 spellings become those of the table; a final dot ("mm/min.") goes.
std::string normalise(std::string_view unit) {
  std::string text;
  for (std::size_t i = 0; i < unit.size();) {
    const auto rest = unit.substr(i);
    const bool is_letter = static_cast<unsigned char>(rest[0]) >= 0xC2 && rest.size() > 1 && (rest[1] & 0xC0) == 0x80;
    const Replacement* found = replacement_in(kReplacements, rest);
    if (found == nullptr && !is_letter) found = replacement_in(kLatin1, rest);
    const std::size_t taken = found != nullptr ? found->from.size() : is_letter ? 2 : 1;  // 2: of another UTF-8 letter
    text += found != nullptr ? found->to : rest.substr(0, taken);
    i += taken;
  }
  while (text.size() > 1 && text.back() == '.') text.pop_back();
  return text;
}

bool matches(std::string_view text, const Unit& unit, const Prefix& prefix) {
  return text.starts_with(prefix.text) && is_in(unit.texts, text.substr(prefix.text.size()), kUnitSeparator);
}

template <class Table>
std::optional<ParsedUnit> with_prefix(std::string_view text, const Unit& unit, const Table& prefixes) {
  for (const Prefix& prefix : prefixes) {
    if (unit.prefixes == Prefixes::Small && !prefix.is_small) continue;
    if (matches(text, unit, prefix)) return ParsedUnit{prefix.factor * unit.factor, unit.powers};
  }
  return std::nullopt;
}

std::optional<ParsedUnit> in_table(std::string_view text) {
  const auto* const whole =
      std::ranges::find_if(kUnitTable, [&](const Unit& unit) { return is_in(unit.texts, text, kUnitSeparator); });
  if (whole != kUnitTable.end()) return ParsedUnit{whole->factor, whole->powers};
  const std::string_view singular = text.ends_with('s') ? text.substr(0, text.size() - 1) : text;
  for (const Unit& unit : kUnitTable) {
    if (unit.prefixes == Prefixes::None) continue;
    const bool is_word = unit.prefixes == Prefixes::Word;
    if (is_word && is_in(unit.texts, singular, kUnitSeparator)) return ParsedUnit{unit.factor, unit.powers};
    const auto found = is_word ? with_prefix(singular, unit, kWordPrefixes) : with_prefix(text, unit, kPrefixes);
    if (found) return found;
  }
  return std::nullopt;
}

std::optional<ParsedUnit> look_up_plain(std::string_view text) {
  const auto exact = in_table(text);
  return exact ? exact : in_table(lower(text));
}

/// The text before "f", "-f", " force" or "_force", in any case; empty where the text does not end so.
std::string_view without_force(std::string_view text) {
  const std::string small = lower(text);
  for (const std::string_view ending : {"force", "f"}) {
    if (!small.ends_with(ending)) continue;
    std::string_view rest = text.substr(0, text.size() - ending.size());
    if (!rest.empty() && std::string_view("-_ ").find(rest.back()) != std::string_view::npos) rest.remove_suffix(1);
    return rest;
  }
  return {};
}

/// A unit of the table, or the weight of a unit of mass: "kgf", "lb-f", "gram force".
std::optional<ParsedUnit> look_up(std::string_view text) {
  if (auto plain = look_up_plain(text)) return plain;
  const std::string_view mass = without_force(text);
  const auto parsed = mass.empty() ? std::nullopt : look_up_plain(mass);
  if (!parsed || parsed->powers != kKilogram) return std::nullopt;
  return ParsedUnit{parsed->factor * kStandardGravity_m_per_s2, kNewton};
}

ParsedUnit product(const ParsedUnit& a, const ParsedUnit& b, int power_of_b) {
  ParsedUnit result{a.factor * std::pow(b.factor, power_of_b), a.powers};
  for (std::size_t base = 0; base < kBases; ++base) result.powers.at(base) += power_of_b * b.powers.at(base);
  return result;
}

class UnitReader {
 public:
  explicit UnitReader(std::string_view text) : rest_(text) {}

  std::optional<ParsedUnit> read() {
    auto unit = read_product();
    return rest_.empty() ? unit : std::nullopt;
  }

 private:
  std::string_view rest_;

  bool take(std::string_view sign) {
    if (!rest_.starts_with(sign)) return false;
    rest_.remove_prefix(sign.size());
    return true;
  }

  void skip_blanks() {
    while (take(" ")) {
    }
  }

  std::optional<ParsedUnit> read_product() {
    auto result = rest_.starts_with("1/") && take("1") ? std::optional(ParsedUnit{}) : read_power();
    while (result) {
      skip_blanks();
      if (rest_.empty() || rest_.front() == ')') return result;
      const bool divides = take("/");
      if (!divides && !take("*") && !take(".")) take("-");  // "in-lbf"; the minus of "mm s-1" is read by read_power
      skip_blanks();
      const auto next = read_power();
      if (!next) return std::nullopt;
      result = product(*result, *next, divides ? -1 : 1);
    }
    return result;
  }

  std::optional<ParsedUnit> read_power() {
    const auto unit = take("(") ? read_brackets() : read_name();
    if (!unit) return std::nullopt;
    const bool has_sign = take("^") || take("**");
    const bool is_hyphen =
        rest_.size() > 1 && rest_[0] == '-' && std::isalpha(static_cast<unsigned char>(rest_[1])) != 0;
    const bool is_negative = !is_hyphen && take("-");
    int power = 0;
    for (int digits = 0; digits < 2 && !rest_.empty() && std::isdigit(static_cast<unsigned char>(rest_.front())) != 0;
         ++digits) {
      power = 10 * power + (rest_.front() - '0');
      rest_.remove_prefix(1);
    }
    if (power == 0) return has_sign || is_negative ? std::nullopt : unit;
    return product({}, *unit, is_negative ? -power : power);
  }

  std::optional<ParsedUnit> read_brackets() {
    auto unit = read_product();
    return take(")") ? unit : std::nullopt;
  }

  std::optional<ParsedUnit> read_name() {
    const auto is_letter = [](char c) {
      const auto byte = static_cast<unsigned char>(c);
      return std::isalpha(byte) != 0 || byte >= 0x80 || c == '_' || c == '%';
    };
    const auto* const end = std::ranges::find_if_not(rest_, is_letter);
    const std::string_view name = rest_.substr(0, static_cast<std::size_t>(end - rest_.begin()));
    rest_.remove_prefix(name.size());
    return name.empty() ? std::nullopt : look_up(name);
  }
};

}  // namespace

std::optional<ParsedUnit> read_unit(std::string_view text) {
  if (text.empty() || text.size() > kLongestUnit) return std::nullopt;
  const std::string unit = normalise(text);
  auto parsed = look_up(unit);
  if (!parsed) parsed = UnitReader(unit).read();
  const bool usable = parsed && std::isfinite(parsed->factor) && parsed->factor > 0.0;
  return usable ? parsed : std::nullopt;
}

}  // namespace slipfit
