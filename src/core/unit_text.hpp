#pragma once

#include <array>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string_view>

// Every unit that slipfit reads or recognises. docs/recordings.md shows those that it reads.

namespace slipfit {

constexpr double kStandardGravity_m_per_s2 = 9.80665;  // exact by definition (CGPM 1901)
constexpr double kTurn_rad = 2.0 * std::numbers::pi;

enum Base : std::size_t { kLength, kMass, kTime, kCurrent, kTemperature, kLight, kAngle, kTurns, kOther, kBases };

/// Exponents of the bases. Turns are kept apart from radians: "rpm" is a frequency too, "rad/s" is not. `kOther` is
/// for what slipfit recognises and never converts, such as counts, decibels and humidity.
using Powers = std::array<int, kBases>;

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

constexpr Powers kPureNumber{};
constexpr Powers kMetre{1};
constexpr Powers kKilogram{0, 1};
constexpr Powers kSecond{0, 0, 1};
constexpr Powers kPerSecond{0, 0, -1};
constexpr Powers kSpeed{1, 0, -1};
constexpr Powers kNewton{1, 1, -2};
constexpr Powers kKilogramMetre{1, 1};
constexpr Powers kPascal{-1, 1, -2};
constexpr Powers kJoule{2, 1, -2};
constexpr Powers kWatt{2, 1, -3};
constexpr Powers kVolt{2, 1, -3, -1};
constexpr Powers kOhm{2, 1, -3, -2};
constexpr Powers kAmpere{0, 0, 0, 1};
constexpr Powers kFarad{-2, -1, 4, 2};
constexpr Powers kTesla{0, 1, -2, -1};
constexpr Powers kKelvin{0, 0, 0, 0, 1};
constexpr Powers kCandela{0, 0, 0, 0, 0, 1};
constexpr Powers kLux{-2, 0, 0, 0, 0, 1};
constexpr Powers kRadian{0, 0, 0, 0, 0, 0, 1};
constexpr Powers kTurn{0, 0, 0, 0, 0, 0, 0, 1};
constexpr Powers kTurnsPerSecond{0, 0, -1, 0, 0, 0, 0, 1};
constexpr Powers kRadiansPerSecond{0, 0, -1, 0, 0, 0, 1};
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

    // A unit of mass with "f" or "force" behind it ("kgf", "lb-f", "gram force") is read as its weight: unit_text.cpp.
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

/// A parsed unit: a factor to SI and the powers of the bases.
struct ParsedUnit {
  double factor = 1.0;
  Powers powers{};
};

/// Units of the table with prefixes, their products ("N m", "N*m", "N.m"), quotients ("mm/min", from left to right) and
/// whole powers ("s-1", "mm^3", "m\xC2\xB2"), brackets included ("mm3/(N m)"). Capitals count where they make a unit of
/// the table, else not ("RPM", "Sec", "MM/S"). Empty where the text is no unit.
std::optional<ParsedUnit> read_unit(std::string_view text);

}  // namespace slipfit
