#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/html/figure.hpp"

namespace slipfit::html {

struct OverlaidRecording {
  const Recording& recording;
  const Analysis& analysis;
};

/// What is drawn in one colour, under one name: a recording of a sweep, a side of a comparison.
struct OverlaidSet {
  std::string name;
  std::vector<OverlaidRecording> recordings;
};

/// Any of the recordings has cycles to lay over others.
bool has_cycles(const OverlaidSet& set);

/// How to read what `overlay_of` draws.
inline constexpr std::string_view kOverlayGuide =
    "Every cycle moved so that its slip begins at zero and its kinetic friction lies at zero force. Above: whole "
    "cycles over the path of the drive, where sticks rise by the stiffness at any speed; below, where samples resolve "
    "them: "
    "slips close up over time, whose shape shows natural frequency and damping.";

/// Cycles of all sets, about as many of each. At least one of the sets has cycles.
chart::Chart overlay_of(const std::string& title, const std::vector<OverlaidSet>& sets);

}  // namespace slipfit::html
