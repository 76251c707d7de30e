#pragma once

#include <array>
#include <cstddef>
#include <numbers>
#include <string_view>

// Every unit that slipfit reads or recognises. docs/recordings.md shows those that it reads.

namespace slipfit {

constexpr double kStandardGravity_m_per_s2 = 9.80665;  // exact by definition (CGPM 1901)
constexpr double kTurn_rad = 2.0 * std::numbers::pi;

enum Base : std::size_t { kLength, kMass, kTime, kCurrent, kTemperature, kLight, kAngle, kTurns, kOther, kBases };

/// Exponents of the bases. Turns are kept apart from radians: "rpm" is a frequency too, "rad/s" is not. `kOther` stands
/// for what slipfit recognises and never converts, such as counts, decibels and humidity.
using Powers = std::array<int, kBases>;

/// Which prefixes a unit takes. Not those that nobody writes: "Mm", "Ms" and "Mg" are millimetres, milliseconds and
/// milligrams with a capital, "Min" is a minute and no mega-inch.
enum class Prefixes { None, Small, Metric, Word };

struct Unit {
  std::string_view text;
  double factor = 1.0;  ///< to kg, m, s, A, K, cd, rad
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

constexpr std::array kUnitTable = std::to_array<Unit>({
    {"s", 1.0, kSecond, Prefixes::Small},
    {"sec", 1.0, kSecond, Prefixes::Small},
    {"secs", 1.0, kSecond, Prefixes::Small},
    {"sek", 1.0, kSecond, Prefixes::Small},
    {"second", 1.0, kSecond, Prefixes::Word},
    {"sekunde", 1.0, kSecond, Prefixes::Word},
    {"sekunden", 1.0, kSecond},
    {"millis", 1e-3, kSecond},
    {"micros", 1e-6, kSecond},
    {"min", 60.0, kSecond},
    {"mins", 60.0, kSecond},
    {"minute", 60.0, kSecond, Prefixes::Word},
    {"minuten", 60.0, kSecond},
    {"h", 3600.0, kSecond},
    {"hr", 3600.0, kSecond},
    {"hrs", 3600.0, kSecond},
    {"hour", 3600.0, kSecond, Prefixes::Word},
    {"stunde", 3600.0, kSecond},
    {"stunden", 3600.0, kSecond},
    {"d", 86400.0, kSecond},
    {"day", 86400.0, kSecond, Prefixes::Word},

    {"m", 1.0, kMetre, Prefixes::Small},
    {"cm", 1e-2, kMetre},
    {"dm", 1e-1, kMetre},
    {"km", 1e3, kMetre},
    {"meter", 1.0, kMetre, Prefixes::Word},
    {"metre", 1.0, kMetre, Prefixes::Word},
    {"micron", 1e-6, kMetre, Prefixes::Word},
    {"in", 0.0254, kMetre},
    {"uin", 0.0254e-6, kMetre},
    {"inch", 0.0254, kMetre, Prefixes::Word},
    {"inches", 0.0254, kMetre},
    {"mil", 0.0254e-3, kMetre},
    {"ft", 0.3048, kMetre},
    {"foot", 0.3048, kMetre},
    {"feet", 0.3048, kMetre},
    {"yd", 0.9144, kMetre},
    {"yard", 0.9144, kMetre, Prefixes::Word},
    {"mile", 1609.344, kMetre, Prefixes::Word},

    {"g", 1e-3, kKilogram, Prefixes::Small},
    {"gm", 1e-3, kKilogram},
    {"kg", 1.0, kKilogram},
    {"kgs", 1.0, kKilogram},
    {"gram", 1e-3, kKilogram, Prefixes::Word},
    {"lb", kPound_kg, kKilogram},
    {"lbs", kPound_kg, kKilogram},
    {"pound", kPound_kg, kKilogram, Prefixes::Word},
    {"oz", kPound_kg / 16.0, kKilogram},  // never the fluid ounce
    {"ounce", kPound_kg / 16.0, kKilogram, Prefixes::Word},

    {"N", 1.0, kNewton, Prefixes::Metric},
    {"kn", 1e3, kNewton},  // KN
    {"newton", 1.0, kNewton, Prefixes::Word},
    {"gf", kGram_N, kNewton, Prefixes::Small},
    {"kgf", 1e3 * kGram_N, kNewton},
    {"p", kGram_N, kNewton},
    {"pond", kGram_N, kNewton, Prefixes::Word},
    {"kp", 1e3 * kGram_N, kNewton},
    {"gram_force", kGram_N, kNewton, Prefixes::Word},
    {"lbf", kPound_kg* kStandardGravity_m_per_s2, kNewton},
    {"pound_force", kPound_kg* kStandardGravity_m_per_s2, kNewton},
    {"ozf", kPound_kg / 16.0 * kStandardGravity_m_per_s2, kNewton},
    {"ounce_force", kPound_kg / 16.0 * kStandardGravity_m_per_s2, kNewton},
    {"dyn", 1e-5, kNewton},
    {"dyne", 1e-5, kNewton, Prefixes::Word},

    {"mps", 1.0, kSpeed},
    {"ipm", 0.0254 / 60.0, kSpeed},
    {"mph", 1609.344 / 3600.0, kSpeed},

    {"Hz", 1.0, kTurnsPerSecond, Prefixes::Metric},  // as a speed of rotation: turns
    {"hz", 1.0, kTurnsPerSecond},
    {"khz", 1e3, kTurnsPerSecond},
    {"hertz", 1.0, kTurnsPerSecond, Prefixes::Word},
    {"1/min", 1.0 / 60.0, kTurnsPerSecond},
    {"min-1", 1.0 / 60.0, kTurnsPerSecond},
    {"min^-1", 1.0 / 60.0, kTurnsPerSecond},
    {"sps", 1.0, kPerSecond},
    {"S/s", 1.0, kPerSecond},  // samples, not siemens
    {"kS/s", 1e3, kPerSecond},
    {"MS/s", 1e6, kPerSecond},
    {"samples/s", 1.0, kPerSecond},
    {"samples/sec", 1.0, kPerSecond},
    {"rpm", 1.0 / 60.0, kTurnsPerSecond},
    {"rps", 1.0, kTurnsPerSecond},
    {"r", 1.0, kTurn},
    {"u", 1.0, kTurn},  // U/min
    {"rev", 1.0, kTurn, Prefixes::Word},
    {"turn", 1.0, kTurn, Prefixes::Word},
    {"umdr", 1.0, kTurn},
    {"rad", 1.0, kRadian, Prefixes::Metric},
    {"radian", 1.0, kRadian, Prefixes::Word},
    {"deg", kTurn_rad / 360.0, kRadian, Prefixes::Small},
    {"degree", kTurn_rad / 360.0, kRadian, Prefixes::Word},
    {"grad", 1.0, kUnconverted},  // a degree in German, a gon in English
    {"\xC2\xB0", kTurn_rad / 360.0, kRadian},

    {"1", 1.0, kPureNumber},
    {"-", 1.0, kPureNumber},
    {"%", 1e-2, kPureNumber},
    {"\xE2\x80\xB0", 1e-3, kPureNumber},
    {"ppm", 1e-6, kPureNumber},

    // Recognised beside a force, so that a units row with them is one.
    {"NM", 1.0, kJoule},  // never a nanometre
    {"Nm", 1.0, kJoule, Prefixes::Metric},
    {"Nmm", 1e-3, kJoule, Prefixes::Metric},
    {"Ncm", 1e-2, kJoule},
    {"J", 1.0, kJoule, Prefixes::Metric},
    {"W", 1.0, kWatt, Prefixes::Metric},
    {"Pa", 1.0, kPascal, Prefixes::Metric},
    {"kpa", 1e3, kPascal},
    {"bar", 1e5, kPascal, Prefixes::Metric},
    {"psi", kPound_kg* kStandardGravity_m_per_s2 / (0.0254 * 0.0254), kPascal},
    {"atm", 101325.0, kPascal},
    {"torr", 101325.0 / 760.0, kPascal, Prefixes::Small},
    {"mmHg", 133.322387415, kPascal},
    {"V", 1.0, kVolt, Prefixes::Metric},
    {"Vrms", 1.0, kVolt, Prefixes::Small},
    {"Vpp", 1.0, kVolt, Prefixes::Small},
    {"volt", 1.0, kVolt, Prefixes::Word},
    {"A", 1.0, kAmpere, Prefixes::Metric},
    {"ampere", 1.0, kAmpere, Prefixes::Word},
    {"Ohm", 1.0, kOhm, Prefixes::Metric},
    {"ohm", 1.0, kOhm, Prefixes::Metric},
    {"ohms", 1.0, kOhm, Prefixes::Metric},
    {"nF", 1e-9, kFarad},
    {"pF", 1e-12, kFarad},
    {"uF", 1e-6, kFarad},
    {"mT", 1e-3, kTesla},
    {"uT", 1e-6, kTesla},
    {"K", 1.0, kKelvin, Prefixes::Small},
    {"C", 1.0, kKelvin},
    {"\xC2\xB0\x43", 1.0, kKelvin},
    {"\xC2\xB0\x46", 5.0 / 9.0, kKelvin},
    {"degC", 1.0, kKelvin},
    {"degc", 1.0, kKelvin},
    {"degF", 5.0 / 9.0, kKelvin},
    {"celsius", 1.0, kKelvin},
    {"lx", 1.0, kLux, Prefixes::Metric},
    {"lux", 1.0, kLux, Prefixes::Metric},
    {"lm", 1.0, kCandela, Prefixes::Metric},
    {"cd", 1.0, kCandela},
    {"ml", 1e-6, kLitre},
    {"mL", 1e-6, kLitre},
    {"ul", 1e-9, kLitre},
    {"uL", 1e-9, kLitre},
    {"l/min", 1e-3 / 60.0, kLitresPerSecond},
    {"L/min", 1e-3 / 60.0, kLitresPerSecond},
    {"sccm", 1e-6 / 60.0, kLitresPerSecond},
    {"slm", 1e-3 / 60.0, kLitresPerSecond},
    {"cP", 1e-3, {-1, 1, -1}},
    {"cSt", 1e-6, {2, 0, -1}},
    {"dB", 1.0, kUnconverted},
    {"db", 1.0, kUnconverted},
    {"dBA", 1.0, kUnconverted},
    {"dB(A)", 1.0, kUnconverted},
    {"dBm", 1.0, kUnconverted},
    {"dBFS", 1.0, kUnconverted},
    {"%RH", 1.0, kUnconverted},
    {"% RH", 1.0, kUnconverted},
    {"%rh", 1.0, kUnconverted},
    {"% rh", 1.0, kUnconverted},
    {"%rF", 1.0, kUnconverted},
    {"% rF", 1.0, kUnconverted},
    {"%r.F", 1.0, kUnconverted},
    {"% r.F", 1.0, kUnconverted},
    {"count", 1.0, kUnconverted, Prefixes::Word},
    {"cts", 1.0, kUnconverted},
    {"digit", 1.0, kUnconverted, Prefixes::Word},
    {"lsb", 1.0, kUnconverted},
    {"a.u", 1.0, kUnconverted},
    {"arb", 1.0, kUnconverted},
    {"arb. u", 1.0, kUnconverted},
});

}  // namespace slipfit
