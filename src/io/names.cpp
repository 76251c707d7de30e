#include "io/names.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

#include "core/unit_text.hpp"
#include "core/word_list.hpp"
#include "io/cells.hpp"
#include "io/message.hpp"

namespace slipfit::reading {

namespace {

// The words by which testers name their columns (English, German, French, Spanish and Italian), in lower case, parted
// by blanks.

constexpr std::string_view kWordsNotUnits = "in In IN Min MIN mil foot feet day days turn turns rev count digit arb";
/// Words in brackets after a name that are not units: "Force (left)", "Time (UTC)".
constexpr std::string_view kRemarks =
    "left right top bottom front rear upper lower links rechts oben unten gauche droite axial radial channel ch kanal "
    "sensor cell transducer measured calculated calc calibrated corrected absolute abs relative rel mean avg average "
    "mittel mittelwert filtered filt smoothed smooth gefiltert gemessen korrigiert peak max local utc gmt absolut "
    "total gesamt tared static dynamic kinetic analog";
constexpr std::string_view kTime =
    "time zeit timestamp timestamps elapsed t tid temps tiempo tempo testzeit messzeit laufzeit prüfzeit pruefzeit "
    "millis "
    "micros zeitstempel versuchszeit uhrzeit clock seconds sec secs msec";
constexpr std::string_view kOtherQuantity =
    "stress spannung pressure druck work arbeit energy energie temp temperature temperatur "
    "humidity feuchte voltage acceleration accel beschleunigung power wear "
    "verschleiss verschleiß radius angle winkel frequency frequenz stiffness mass thickness vibration";
constexpr std::string_view kTorque = "torque moment drehmoment reibmoment reibungsmoment couple coppia";
constexpr std::string_view kVelocity =
    "velocity speed geschwindigkeit rpm drehzahl v vitesse velocidad velocità gleitgeschwindigkeit";
constexpr std::string_view kStep = "step schritt segment stage phase abschnitt testschritt recipestep stepno";
constexpr std::string_view kCounter =
    "cycle cycles zyklus zyklen index idx sample samples no nr number lap laps turns status marker event counter id";
constexpr std::string_view kDisplacement =
    "displacement displ disp strain position pos weg standardweg stroke travel distance dist extension dehnung "
    "verschiebung hub path auslenkung traverse traversenweg crosshead elongation deflection déplacement deplacement "
    "desplazamiento spostamento";
constexpr std::string_view kForce = "force forces kraft standardkraft fuerza forza effort f";
constexpr std::string_view kLoad = "load last loadcell weight charge carga carico";
constexpr std::string_view kNominal = "applied nominal set soll target setpoint";
constexpr std::string_view kNormal =
    "fn fz normal normale normalkraft normallast normalforce vertical downforce auflast preload vorlast";
constexpr std::string_view kCoefficient =
    "cof mu µ μ mue reibwert reibzahl reibungszahl reibungskoeffizient reibkoeffizient reibbeiwert coefficient coeff "
    "koeffizient";
constexpr std::string_view kFriction =
    "friction frictional reibung frict frottement fricción friccion rozamiento attrito";
constexpr std::string_view kTangential =
    "ft ff fr ffric ftan tangential shear traction drag reibkraft reibungskraft tangentialkraft zugkraft scherkraft "
    "pull pulling frictionforce tangentialforce tangentielle tangencial tangenziale";
constexpr std::string_view kLateral = "fx fy lateral querkraft horizontal";  // one of them may be the tangential force

/// Words that name a column as often as a unit: after a blank or an underscore they are no unit ("Force_Min").
bool may_be_a_word(std::string_view unit) {
  const bool is_letter = unit.size() == 1 && unit != "s" && unit != "N" && unit != "g" && unit != "m" && unit != "h";
  return is_letter || is_in(kWordsNotUnits, unit);
}

struct NameAndUnit {
  std::string_view base;
  std::string_view unit;
};

/// Lower-case words: "StandardForce_2" is "standard", "force"; letters beyond ASCII count as letters.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  bool in_word = false;
  bool after_lower = false;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_letter = std::isalpha(byte) != 0 || byte >= 0x80;
    if (is_letter && (!in_word || (after_lower && std::isupper(byte) != 0))) words.emplace_back();
    if (is_letter) words.back() += static_cast<char>(byte < 0x80 ? std::tolower(byte) : c);
    in_word = is_letter;
    after_lower = std::islower(byte) != 0;
  }
  if (words.size() > 1 && words[0] == "f" && words[1].size() == 1) {  // "F_n", "F x"
    words[1].insert(words[1].begin(), 'f');
    words.erase(words.begin());
  }
  return words;
}

bool has(const std::vector<std::string>& words, std::string_view list) {
  return std::ranges::any_of(words, [list](const std::string& word) { return is_in(list, word); });
}

/// Returns true if a text in brackets after a name or after a slash is a unit, known or not: "Force (daN)", "F/raw".
/// "Force (left)" and "Ft/Fn" are not, nor are more than two words.
bool is_in_place_of_unit(std::string_view text) {
  const UnitClass known = classify_unit(text);
  if (known != UnitClass::NotAUnit) return known != UnitClass::None;
  const std::vector<std::string> words = words_of(text);
  if (words.empty() || words.size() > 2) return false;
  const auto says_other = [](const std::string& word) {
    const bool is_letter = word.size() == 1;
    const bool is_of_a_name = std::ranges::any_of(
        std::array{kRemarks, kTime, kForce, kLoad, kNominal, kNormal, kCoefficient, kFriction, kTangential, kLateral,
                   kVelocity, kTorque, kStep, kCounter, kDisplacement, kOtherQuantity},
        [&word](std::string_view list) { return is_in(list, word); });
    return is_letter || is_of_a_name;
  };
  const auto is_digit_at = [&text](std::size_t i) {
    return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])) != 0;
  };
  const bool is_scaled =  // "N*10", "x10"
      text.find_first_of("*^") != std::string_view::npos || (words.front() == "x" && is_digit_at(1));
  const bool is_channel = text.find_first_of("0123456789") != std::string_view::npos;  // "ai0", "SG1"
  return is_scaled || (!is_channel && std::ranges::none_of(words, says_other));
}

NameAndUnit take_brackets(std::string_view name, char open, char close) {
  const auto end = name.rfind(close);
  const auto begin = end == std::string_view::npos ? end : name.rfind(open, end);
  if (begin == std::string_view::npos) return {name, {}};
  const std::string_view inside = trim(name.substr(begin + 1, end - begin - 1));
  if (open == '(' && !is_in_place_of_unit(inside)) return {name, {}};
  return {trim(name.substr(0, begin)), inside};
}

bool is_unit(UnitClass unit) {
  return unit != UnitClass::None && unit != UnitClass::NotAUnit;
}

/// Returns the underscore before the unit of a name: the last one, or that before "m_per_s" and "N_m".
std::size_t underscore_before_unit(std::string_view name) {
  const auto per = name.rfind("_per_");
  const auto last = name.rfind('_');
  const auto inner = std::min(per, last);
  if (inner == std::string_view::npos || inner == 0) return last;
  const auto at = name.rfind('_', inner - 1);
  if (at == std::string_view::npos) return last;
  const UnitClass composed = classify_unit(name.substr(at + 1));
  const bool is_composed = inner == per ? is_unit(composed) : composed == UnitClass::Torque;
  return is_composed ? at : last;
}

/// "F / N", "Force, N", "time, in s" (no inch-second), "Kraft in N", "force_N", "speed_m_per_s", "Time s".
NameAndUnit take_suffix(std::string_view name) {
  for (const std::string_view separator : {"/", ",", " in ", "_", " "}) {
    const auto at = separator == "_" ? underscore_before_unit(name) : name.rfind(separator);
    if (at == std::string_view::npos || at == 0) continue;
    std::string_view unit = trim(name.substr(at + separator.size()));
    if (separator == "," && unit.starts_with("in ")) unit = trim(unit.substr(3));
    const bool has_inch = separator == " in " && has(words_of(name.substr(0, at)), kTorque);
    if (has_inch && unit.find_first_of("bz") != std::string_view::npos) {  // "Torque in lbf", "Torque in ozf"
      const std::string_view with_inch = name.substr(at + 1);
      if (classify_unit(with_inch) == UnitClass::Torque) return {trim(name.substr(0, at)), with_inch};
    }
    const UnitClass unit_class = classify_unit(unit);
    const bool is_loose = separator == "_" || separator == " ";  // "Sensor A", "Channel 1", "Load C"
    if (!is_unit(unit_class) || (is_loose && may_be_a_word(unit))) continue;
    return {trim(name.substr(0, at)), unit};
  }
  const auto slash = name.rfind('/');
  if (slash == std::string_view::npos || slash == 0) return {name, {}};
  const std::string_view after = trim(name.substr(slash + 1));
  if (after.find(' ') != std::string_view::npos || !is_in_place_of_unit(after)) return {name, {}};
  return {trim(name.substr(0, slash)), after};
}

NameAndUnit separate_unit(std::string_view name) {
  for (const std::string_view brackets : {"[]", "()", "{}"}) {
    const NameAndUnit found = take_brackets(name, brackets[0], brackets[1]);
    if (!found.unit.empty()) return found;
  }
  return take_suffix(name);
}

/// "Force X", "Z-Force" are "fx", "fz".
std::vector<std::string> with_direction(std::vector<std::string> words) {
  const auto letter = std::ranges::find_if(words, [](const std::string& word) {
    return word.size() == 1 && std::string_view("xyz").find(word) != std::string_view::npos;
  });
  const bool is_force = std::ranges::any_of(words, [](const auto& word) { return is_in(kForce, word); });
  if (is_force && letter != words.end()) letter->insert(letter->begin(), 'f');
  return words;
}

struct RoleAndRank {
  Role role;
  int rank;
};

/// A letter alone is a speed only where its unit says so ("v [mm/s]"): it may be a voltage.
RoleAndRank speed_role(const std::vector<std::string>& words, UnitClass unit) {
  const bool is_speed_unit = unit == UnitClass::Speed || unit == UnitClass::Rotation;
  const bool is_letter = std::ranges::all_of(words, [](const auto& word) { return word.size() == 1; });
  if (!is_speed_unit && (is_letter || unit != UnitClass::None)) return {Role::Other, 0};
  return {Role::Speed, is_letter || has(words, kNominal) ? 1 : 2};
}

/// The order matters: "normal stress" is no force, "normal force" not the tangential one, "Friction [N]" no
/// coefficient.
RoleAndRank role_of(const std::vector<std::string>& words, UnitClass unit) {
  const bool unit_allows_force = unit == UnitClass::None || unit == UnitClass::Force || unit == UnitClass::Mass;
  const bool is_force_unit = unit == UnitClass::Force || unit == UnitClass::Mass;
  const bool says_force = has(words, kForce) || has(words, kLoad);
  if (has(words, kTime) && (unit == UnitClass::Time || unit == UnitClass::None || unit == UnitClass::NotAUnit)) {
    return {Role::Time, words.size() == 1 ? 3 : 2};
  }
  if (has(words, kOtherQuantity)) return {Role::Other, 0};
  if (has(words, kTorque)) {
    return {unit == UnitClass::None || unit == UnitClass::Torque || unit == UnitClass::NotAUnit ? Role::Torque
                                                                                                : Role::Other,
            2};
  }
  if (has(words, kVelocity) && words.front() != "f") return speed_role(words, unit);
  if (has(words, kStep) && (unit == UnitClass::None || unit == UnitClass::One)) {
    return {Role::Step, words.size() == 1 ? 2 : 1};
  }
  if (has(words, kDisplacement) && !is_force_unit && !says_force) {
    return {has(words, kNormal) ? Role::Other : Role::Displacement, 2};
  }
  if (has(words, kCoefficient) && !is_force_unit) return {Role::FrictionCoefficient, 3};
  if (has(words, kNormal) || (has(words, kLoad) && has(words, kNominal))) {
    return {Role::NormalForce, has(words, kNominal) ? 1 : 2};
  }
  if (has(words, kFriction)) {
    if (is_force_unit || says_force) return {Role::TangentialForce, 4};
    return {unit == UnitClass::None || unit == UnitClass::One ? Role::FrictionCoefficient : Role::Other, 2};
  }
  if (unit == UnitClass::Time || unit == UnitClass::Length) {
    return {unit == UnitClass::Time ? Role::Time : Role::Displacement, 1};
  }
  if (has(words, kTangential)) return {Role::TangentialForce, 4};
  if (has(words, kLateral)) return {Role::TangentialForce, 3};
  if (has(words, kForce) && (words.front() != "f" || unit_allows_force)) return {Role::TangentialForce, 2};
  if (has(words, kLoad)) return {Role::TangentialForce, 1};
  if (unit == UnitClass::Force) return {Role::TangentialForce, 1};
  if (unit == UnitClass::Torque) return {Role::Torque, 1};
  const bool is_other = unit == UnitClass::Other || unit == UnitClass::Speed || unit == UnitClass::Rotation;
  return {is_other || has(words, kCounter) ? Role::Other : Role::Unknown, 0};
}

}  // namespace

UnitClass classify_unit(std::string_view unit) {
  if (unit.empty()) return UnitClass::None;
  const bool is_letter =
      unit.size() == 1 && std::string_view("smhgNJWVACK1-%\xB0").find(unit) == std::string_view::npos;
  const auto parsed = is_letter ? std::nullopt : read_unit(unit);
  if (!parsed) return UnitClass::NotAUnit;
  if (parsed->powers == kSecond) return UnitClass::Time;
  if (parsed->powers == kMetre) return UnitClass::Length;
  if (parsed->powers == kNewton) return UnitClass::Force;
  if (parsed->powers == kKilogram) return UnitClass::Mass;
  if (parsed->powers == kSpeed) return UnitClass::Speed;
  if (parsed->powers == kTurnsPerSecond || parsed->powers == kRadiansPerSecond) return UnitClass::Rotation;
  const bool is_energy = lower(unit).find('j') != std::string::npos;  // "J", "mJ"
  if (!is_energy && (parsed->powers == kJoule || parsed->powers == kKilogramMetre)) return UnitClass::Torque;
  const bool is_number = parsed->powers == kPureNumber && unit.find('/') == std::string_view::npos;
  return is_number ? UnitClass::One : UnitClass::Other;
}

bool is_load(const ColumnName& name) {
  return has(words_of(name.base), kLoad);
}

ColumnName read_name(std::string_view name_cell, std::string_view unit_cell) {
  ColumnName name;
  name.text = printable_utf8(unquote(name_cell));
  std::string unit_text = printable_utf8(unquote(unit_cell));
  if (unit_text.size() > 2 && std::string_view("[({").find(unit_text.front()) != std::string_view::npos) {
    unit_text = unit_text.substr(1, unit_text.size() - 2);
  }
  const NameAndUnit parts = unit_text.empty() ? separate_unit(name.text) : NameAndUnit{name.text, unit_text};
  name.base = std::string(parts.base);
  name.unit = std::string(trim(parts.unit));
  const RoleAndRank found = role_of(with_direction(words_of(name.base)), classify_unit(name.unit));
  name.role = found.role;
  name.rank = found.rank;
  return name;
}

}  // namespace slipfit::reading
