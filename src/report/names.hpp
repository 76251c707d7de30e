#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "slipfit/compare.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/surface/surface.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit {

/// The words of the JSON document for a type, in the order of its enumerators; docs/formats.md lists them.
template <class Choice>
inline constexpr std::array<std::string_view, 0> kNames{};

template <>
inline constexpr auto kNames<Tier> = std::to_array<std::string_view>({"sawtooth", "undamped", "damped", "velocity",
                                                                      "weakening"});
template <>
inline constexpr auto kNames<ForceView> = std::to_array<std::string_view>({"spring", "transmitted", "contact"});
template <>
inline constexpr auto kNames<ForceQuantity> = std::to_array<std::string_view>({"force", "friction_coefficient"});
template <>
inline constexpr auto kNames<LevelReading> = std::to_array<std::string_view>({"open", "sensor", "friction", "none"});
template <>
inline constexpr auto kNames<MotionClass> = std::to_array<std::string_view>({"stick_slip", "steady_sliding",
                                                                             "oscillatory_slip", "undetermined"});
template <>
inline constexpr auto kNames<ParameterStatus> =
    std::to_array<std::string_view>({"identified", "weak", "bounded", "unidentified", "fixed", "conditional"});
template <>
inline constexpr auto kNames<SweepRole> = std::to_array<std::string_view>({"cycles", "steady", "left_out"});
template <>
inline constexpr auto kNames<Regularity> = std::to_array<std::string_view>({"regular", "irregular", "clocked"});
template <>
inline constexpr auto kNames<Regime> = std::to_array<std::string_view>({"stick_slip", "stick_slip_bistable",
                                                                        "oscillatory_slip", "continuous_slip",
                                                                        "unstable_steady"});
template <>
inline constexpr auto kNames<FrequencyMethod> =
    std::to_array<std::string_view>({"none", "fitted_cycles", "harmonic_least_squares", "slip_counting"});
template <>
inline constexpr auto kNames<TestKind> = std::to_array<std::string_view>({"period_drift", "level_repeats", "return_map",
                                                                          "ageing", "stated_mass", "sensor_resonance"});
template <>
inline constexpr auto kNames<SurfaceStatus> = std::to_array<std::string_view>({"periodic", "irregular", "none",
                                                                               "undetermined"});
template <>
inline constexpr auto kNames<SurfaceMethod> = std::to_array<std::string_view>({"ridges", "comb"});
template <>
inline constexpr auto kNames<ComparisonMethod> = std::to_array<std::string_view>({"standard_errors", "welch",
                                                                                  "scatter_of_a", "scatter_of_b"});

/// A type with names.
template <class Choice>
concept Named = !kNames<Choice>.empty();

template <Named Choice>
constexpr std::string_view name_of(Choice choice) {
  return kNames<Choice>.at(static_cast<std::size_t>(choice));
}

/// Returns the choice whose name in the document this is.
template <Named Choice>
std::optional<Choice> with_name(std::string_view name) {
  const auto found = std::ranges::find(kNames<Choice>, name);
  if (found == kNames<Choice>.end()) return std::nullopt;
  return static_cast<Choice>(found - kNames<Choice>.begin());
}

}  // namespace slipfit
