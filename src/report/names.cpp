#include "report/names.hpp"

#include <initializer_list>

namespace slipfit {
namespace {

using Names = std::initializer_list<std::string_view>;

/// The name at the place of the enumerator.
template <class Choice>
std::string_view name_in(Names names, Choice choice) {
  const auto index = static_cast<std::size_t>(choice);
  return index < names.size() ? names.begin()[index] : "unknown";
}

}  // namespace

std::string_view name_of(Tier tier) {
  return name_in({"sawtooth", "undamped", "damped", "velocity", "weakening"}, tier);
}

std::string_view name_of(ForceView view) {
  return name_in({"spring", "transmitted", "contact"}, view);
}

std::string_view name_of(ForceQuantity quantity) {
  return name_in({"force", "friction_coefficient"}, quantity);
}

std::string_view name_of(LevelReading reading) {
  return name_in({"open", "sensor", "friction", "none"}, reading);
}

std::string_view name_of(MotionClass motion) {
  return name_in({"stick_slip", "steady_sliding", "oscillatory_slip", "undetermined"}, motion);
}

std::string_view words_for_motion(MotionClass motion) {
  return name_in(
      {"stick-slip", "steady sliding, no stick-slip", "oscillatory slip (almost no sticks)", "motion undetermined"},
      motion);
}

std::string_view name_of(ParameterStatus status) {
  return name_in({"identified", "weak", "bounded", "unidentified", "fixed", "conditional"}, status);
}

std::string_view words_for_status(ParameterStatus status) {
  return name_in(
      {"the data determine it", "an estimate that should be confirmed", "only an interval is known",
       "the data do not determine it", "fixed at the stated value", "determined if the assumption in its note holds"},
      status);
}

std::string_view name_of(SweepRole role) {
  return name_in({"cycles", "steady", "left_out"}, role);
}

std::string_view name_of(Regularity regularity) {
  return name_in({"regular", "irregular", "clocked"}, regularity);
}

std::string_view name_of(Regime regime) {
  return name_in({"stick_slip", "stick_slip_bistable", "oscillatory_slip", "continuous_slip", "unstable_steady"},
                 regime);
}

std::string_view name_of(FrequencyMethod method) {
  return name_in({"none", "fitted_cycles", "harmonic_least_squares", "slip_counting"}, method);
}

std::string_view name_of(TestKind kind) {
  return name_in({"period_drift", "level_repeats", "return_map", "ageing", "stated_mass", "sensor_resonance"}, kind);
}

}  // namespace slipfit
