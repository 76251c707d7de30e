#include "analysis/conclusions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "slipfit/core/range.hpp"

namespace slipfit {
namespace {

/// The quantities that a wrong unit (by a factor of 1000) makes implausible. The ranges include, with a decade to
/// spare, measured recordings and data sheets: springs and load cells of 0.1 kN/m to 100 MN/m, moving bodies of 0.1 g
/// to 1 t, slips of 10 nm (a thousandth of that is allowed) to 20 mm.
struct Seen {
  std::optional<double> stiffness_N_per_m;
  std::optional<double> mass_kg;
  std::optional<double> spacing_m;
};

constexpr Range kStiffness_N_per_m{10.0, 1e9};
constexpr Range kMass_kg{1e-5, 1e4};
constexpr Range kSpacing_m{1e-9, 0.2};

bool is_outside(const std::optional<double>& value, const Range& range) {
  return value && !(*value >= range.low && *value <= range.high);
}

bool is_plausible(const Seen& seen) {
  return !is_outside(seen.stiffness_N_per_m, kStiffness_N_per_m) && !is_outside(seen.mass_kg, kMass_kg) &&
         !is_outside(seen.spacing_m, kSpacing_m);
}

/// A mistaken unit: what the true numbers are of those seen, and what to ask the user. Without a unit of the clock in
/// the file the clock is the first suspect.
struct Mistake {
  double stiffness = 1.0;
  double mass = 1.0;
  double spacing = 1.0;
  const char* question = "";
  bool is_of_clock = false;
};

constexpr std::array kMistakes = std::to_array<Mistake>({
    {1e3, 1e3, 1e-3, "is the speed in mm/s, 1000 times smaller?"},
    {1e3, 1e-3, 1e-3, "is the time in ms (--time-unit ms)?", true},
    {1e6, 1e-6, 1e-6, "is the time in us (--time-unit us)?", true},
    {1e-3, 1e-3, 1.0, "is the force in mN (--force-unit mN)?"},
    {1e3, 1e3, 1.0, "is the force in kN (--force-unit kN)?"},
    {1e-3, 1e-3, 1e3, "is the speed in m/s, 1000 times larger?"},
});

std::optional<double> scaled(const std::optional<double>& value, double factor) {
  return value ? std::optional(*value * factor) : std::nullopt;
}

std::string remedy_for(const Seen& seen, bool is_time_unit_assumed) {
  std::vector<Mistake> mistakes(kMistakes.begin(), kMistakes.end());
  if (is_time_unit_assumed)
    std::stable_partition(mistakes.begin(), mistakes.end(), [](const Mistake& mistake) { return mistake.is_of_clock; });
  for (const Mistake& mistake : mistakes) {
    if (is_plausible({scaled(seen.stiffness_N_per_m, mistake.stiffness), scaled(seen.mass_kg, mistake.mass),
                      scaled(seen.spacing_m, mistake.spacing)})) {
      return (is_time_unit_assumed && mistake.is_of_clock ? "the file contains no unit of time: " : "") +
             std::string(mistake.question);
    }
  }
  return "check the units of speed, time and force";
}

}  // namespace

std::optional<std::string> implausible_units(const Recording& recording, const Analysis& analysis) {
  const bool has_slips = analysis.motion == MotionClass::StickSlip || analysis.motion == MotionClass::OscillatorySlip;
  if (recording.conditions().quantity != ForceQuantity::Force_N || !has_slips) return std::nullopt;
  Seen seen{analysis.cycles.stick_stiffness.value, std::nullopt, analysis.derived.pattern_spacing_m.value};
  if (const Parameter* const mass = analysis.fit ? analysis.fit->find(ParameterId::Mass) : nullptr) {
    if (mass->status != ParameterStatus::Bounded) seen.mass_kg = mass->estimate.value;
  }
  if (is_plausible(seen)) return std::nullopt;
  std::string what;
  const auto add = [&what](const std::optional<double>& value, const Range& range, const char* words) {
    if (is_outside(value, range)) what += fmt::format("{}{} {:.3g}", what.empty() ? "" : ", ", words, *value);
  };
  add(seen.stiffness_N_per_m, kStiffness_N_per_m, "a stiffness in N/m of");
  add(seen.mass_kg, kMass_kg, "a mass in kg of");
  add(seen.spacing_m, kSpacing_m, "a distance per slip in m of");
  return fmt::format("{} is outside the range of tribometers: {}", what,
                     remedy_for(seen, recording.provenance().is_time_unit_assumed));
}

}  // namespace slipfit
