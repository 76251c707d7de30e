#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "slipfit/pipeline.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit {

// The words of the JSON document; docs/formats.md lists them.
std::string_view name_of(Tier tier);
std::string_view name_of(ForceView view);
std::string_view name_of(ForceQuantity quantity);
std::string_view name_of(LevelReading reading);
std::string_view name_of(MotionClass motion);
std::string_view name_of(ParameterStatus status);
std::string_view name_of(SweepRole role);
std::string_view name_of(Regularity regularity);
std::string_view name_of(Regime regime);
std::string_view name_of(FrequencyMethod method);
std::string_view name_of(TestKind kind);

inline constexpr std::array kMotions{MotionClass::StickSlip, MotionClass::SteadySliding, MotionClass::OscillatorySlip,
                                     MotionClass::Undetermined};
inline constexpr std::array kParameterStatuses{ParameterStatus::Identified, ParameterStatus::Weak,
                                               ParameterStatus::Bounded,    ParameterStatus::Unidentified,
                                               ParameterStatus::Fixed,      ParameterStatus::Conditional};

/// Returns the choice whose name in the document this is.
template <class Choice, std::size_t Count>
std::optional<Choice> with_name(const std::array<Choice, Count>& choices, std::string_view name) {
  const auto found = std::ranges::find(choices, name, [](Choice choice) { return name_of(choice); });
  return found == choices.end() ? std::nullopt : std::optional(*found);
}

/// Returns the kind of motion in words.
std::string_view words_for_motion(MotionClass motion);

/// Returns the meaning of a status for readers without the documentation.
std::string_view words_for_status(ParameterStatus status);

}  // namespace slipfit
