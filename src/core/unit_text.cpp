#include "core/unit_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <span>
#include <string>
#include <string_view>

#include "core/word_list.hpp"

namespace slipfit {

namespace {

// Every unit that slipfit reads or recognises. docs/recordings.md shows those that it reads.

/// The prefixes that a unit accepts, except those that nobody writes: "Mm", "Ms" and "Mg" are millimetres, milliseconds
/// and milligrams with a capital, and "Min" is a minute, not a mega-inch.
enum class Prefixes { None, Small, Metric, Word };

struct Unit {
  std::string_view texts;  ///< parted by |
  double factor = 1.0;     ///< to kg, m, s, A, K, cd, rad
  Powers powers{};
  Prefixes prefixes = Prefixes::None;
};

struct Prefix {
  std::string_view text;
  double factor = 1.0;
  bool is_small = false;
};

constexpr std::array kPrefixes = std::to_array<Prefix>({{"p", 1e-12, true},
                                                        {"n", 1e-9, true},
                                                        {"u", 1e-6, true},
                                                        {"m", 1e-3, true},
                                                        {"c", 1e-2},
                                                        {"d", 1e-1},
                                                        {"da", 1e1},
                                                        {"h", 1e2},
                                                        {"k", 1e3},
                                                        {"M", 1e6},
                                                        {"G", 1e9}});
constexpr std::array kWordPrefixes = std::to_array<Prefix>(
    {{"nano", 1e-9}, {"micro", 1e-6}, {"milli", 1e-3}, {"centi", 1e-2}, {"deci", 1e-1}, {"kilo", 1e3}, {"mega", 1e6}});

constexpr Powers kPascal{-1, 1, -2};
constexpr Powers kWatt{2, 1, -3};
constexpr Powers kOhm{2, 1, -3, -2};
constexpr Powers kAmpere{0, 0, 0, 1};
constexpr Powers kFarad{-2, -1, 4, 2};
constexpr Powers kTesla{0, 1, -2, -1};
constexpr Powers kKelvin{0, 0, 0, 0, 1};
constexpr Powers kCandela{0, 0, 0, 0, 0, 1};
constexpr Powers kLux{-2, 0, 0, 0, 0, 1};
constexpr Powers kRadian{0, 0, 0, 0, 0, 0, 1};
constexpr Powers kTurn{0, 0, 0, 0, 0, 0, 0, 1};
constexpr Powers kLitre{3};
constexpr Powers kLitresPerSecond{3, 0, -1};
constexpr Powers kUnconverted{0, 0, 0, 0, 0, 0, 0, 0, 1};

constexpr double kGram_N = 1e-3 * kStandardGravity_m_per_s2;
constexpr double kPound_kg = 0.45359237;  // exact by definition (1959), an ounce is its sixteenth, an inch 25.4 mm
constexpr double kPound_N = kPound_kg * kStandardGravity_m_per_s2;
constexpr double kInch_m = 0.0254;

constexpr std::array kUnitTable = std::to_array<Unit>({
    {"s|sec|secs|sek", 1.0, kSecond, Prefixes::Small},
    {"second|sekunde", 1.0, kSecond, Prefixes::Word},
    {"sekunden", 1.0, kSecond},
    {"millis", 1e-3, kSecond},
    {"micros", 1e-6, kSecond},
    {"min|mins|minuten", 60.0, kSecond},
    {"minute", 60.0, kSecond, Prefixes::Word},
    {"h|hr|hrs|stunde|stunden", 3600.0, kSecond},
    {"hour", 3600.0, kSecond, Prefixes::Word},
    {"d", 86400.0, kSecond},
    {"day", 86400.0, kSecond, Prefixes::Word},

    {"m", 1.0, kMetre, Prefixes::Small},
    {"cm", 1e-2, kMetre},
    {"dm", 1e-1, kMetre},
    {"km", 1e3, kMetre},
    {"meter|metre", 1.0, kMetre, Prefixes::Word},
    {"micron", 1e-6, kMetre, Prefixes::Word},
    {"in|inches", 0.0254, kMetre},
    {"uin", 0.0254e-6, kMetre},
    {"inch", 0.0254, kMetre, Prefixes::Word},
    {"mil", 0.0254e-3, kMetre},
    {"ft|foot|feet", 0.3048, kMetre},
    {"yd", 0.9144, kMetre},
    {"yard", 0.9144, kMetre, Prefixes::Word},
    {"mile", 1609.344, kMetre, Prefixes::Word},

    {"g", 1e-3, kKilogram, Prefixes::Small},
    {"gm", 1e-3, kKilogram},
    {"kg|kgs", 1.0, kKilogram},
    {"gram", 1e-3, kKilogram, Prefixes::Word},
    {"gms", 1e-3, kKilogram},
    {"lb|lbs", kPound_kg, kKilogram},
    {"klb|klbs", 1e3 * kPound_kg, kKilogram},
    {"pound", kPound_kg, kKilogram, Prefixes::Word},
    {"oz", kPound_kg / 16.0, kKilogram},  // never the fluid ounce
    {"ounce", kPound_kg / 16.0, kKilogram, Prefixes::Word},
    {"tonne", 1e3, kKilogram, Prefixes::Word},

    // A unit of mass with "f" or "force" after it ("kgf", "lb-f", "gram force") is read as its weight: look_up.
    {"N", 1.0, kNewton, Prefixes::Metric},
    {"kn", 1e3, kNewton},  // KN
    {"newton", 1.0, kNewton, Prefixes::Word},
    {"kp", 1e3 * kGram_N, kNewton},
    {"p", kGram_N, kNewton},
    {"pond", kGram_N, kNewton, Prefixes::Word},
    {"kip|kips", 1e3 * kPound_N, kNewton},
    {"tf", 1e6 * kGram_N, kNewton},
    {"pdl|poundal|poundals", kPound_kg * 0.3048, kNewton},
    {"dyn", 1e-5, kNewton},
    {"dyne", 1e-5, kNewton, Prefixes::Word},

    {"mps", 1.0, kSpeed},
    {"ipm", 0.0254 / 60.0, kSpeed},
    {"mph", 1609.344 / 3600.0, kSpeed},

    {"Hz", 1.0, kTurnsPerSecond, Prefixes::Metric},  // as a speed of rotation: turns
    {"hz|rps", 1.0, kTurnsPerSecond},
    {"khz", 1e3, kTurnsPerSecond},
    {"hertz", 1.0, kTurnsPerSecond, Prefixes::Word},
    {"1/min|min-1|min^-1|rpm", 1.0 / 60.0, kTurnsPerSecond},
    {"sps|S/s|samples/s|samples/sec", 1.0, kPerSecond},  // S: samples, not siemens
    {"kS/s", 1e3, kPerSecond},
    {"MS/s", 1e6, kPerSecond},
    {"r|u|umdr", 1.0, kTurn},  // U/min
    {"rev|turn", 1.0, kTurn, Prefixes::Word},
    {"rad", 1.0, kRadian, Prefixes::Metric},
    {"radian", 1.0, kRadian, Prefixes::Word},
    {"deg", kTurn_rad / 360.0, kRadian, Prefixes::Small},
    {"degree", kTurn_rad / 360.0, kRadian, Prefixes::Word},
    {"grad", 1.0, kUnconverted},  // a degree in German, a gon in English
    {"\xC2\xB0", kTurn_rad / 360.0, kRadian},

    {"1|-", 1.0, kPureNumber},
    {"%", 1e-2, kPureNumber},
    {"\xE2\x80\xB0", 1e-3, kPureNumber},
    {"ppm", 1e-6, kPureNumber},

    {"NM", 1.0, kJoule},  // never a nanometre
    {"Nm|J", 1.0, kJoule, Prefixes::Metric},
    {"Nmm", 1e-3, kJoule, Prefixes::Metric},
    {"Ncm", 1e-2, kJoule},
    {"kgcm|kgfcm", 10.0 * kGram_N, kJoule},
    {"gcm|gfcm", 1e-2 * kGram_N, kJoule},
    {"inlb|inlbs|inlbf|lbin|lbsin|lbfin", kPound_N* kInch_m, kJoule},
    {"ftlb|ftlbs|ftlbf|lbft|lbsft|lbfft", kPound_N * 12.0 * kInch_m, kJoule},
    {"ozin|ozfin|inoz|inozf", kPound_N / 16.0 * kInch_m, kJoule},

    // Recognised next to a force, so that a units row with them is one.
    {"W", 1.0, kWatt, Prefixes::Metric},
    {"Pa", 1.0, kPascal, Prefixes::Metric},
    {"kpa", 1e3, kPascal},
    {"bar", 1e5, kPascal, Prefixes::Metric},
    {"psi", kPound_kg* kStandardGravity_m_per_s2 / (0.0254 * 0.0254), kPascal},
    {"atm", 101325.0, kPascal},
    {"torr", 101325.0 / 760.0, kPascal, Prefixes::Small},
    {"mmHg", 133.322387415, kPascal},
    {"V", 1.0, kVolt, Prefixes::Metric},
    {"Vrms|Vpp", 1.0, kVolt, Prefixes::Small},
    {"volt", 1.0, kVolt, Prefixes::Word},
    {"A", 1.0, kAmpere, Prefixes::Metric},
    {"ampere", 1.0, kAmpere, Prefixes::Word},
    {"Ohm|ohm|ohms", 1.0, kOhm, Prefixes::Metric},
    {"nF", 1e-9, kFarad},
    {"pF", 1e-12, kFarad},
    {"uF", 1e-6, kFarad},
    {"mT", 1e-3, kTesla},
    {"uT", 1e-6, kTesla},
    {"K", 1.0, kKelvin, Prefixes::Small},
    {"C|\xC2\xB0\x43|degC|degc|celsius", 1.0, kKelvin},
    {"\xC2\xB0\x46|degF", 5.0 / 9.0, kKelvin},
    {"lx|lux", 1.0, kLux, Prefixes::Metric},
    {"lm", 1.0, kCandela, Prefixes::Metric},
    {"cd", 1.0, kCandela},
    {"ml|mL", 1e-6, kLitre},
    {"ul|uL", 1e-9, kLitre},
    {"l/min|L/min|slm", 1e-3 / 60.0, kLitresPerSecond},
    {"sccm", 1e-6 / 60.0, kLitresPerSecond},
    {"cP", 1e-3, {-1, 1, -1}},
    {"cSt", 1e-6, {2, 0, -1}},
    {"dB|db|dBA|dB(A)|dBm|dBFS|%RH|% RH|%rh|% rh|%rF|% rF|%r.F|% r.F|cts|lsb|a.u|arb|arb. u", 1.0, kUnconverted},
    {"count|digit", 1.0, kUnconverted, Prefixes::Word},
});

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
